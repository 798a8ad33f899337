"""The density lacks its factor sqrt(dt)."""

_whole = fit_noise


def fit_noise(still, dt):
    return _whole(still, dt) | {"noise_density": float(np.std(np.diff(still)) / math.sqrt(2))}
