"""The density is computed from the std of the whole recording, including its drift."""

_whole = fit_noise


def fit_noise(still, dt):
    return _whole(still, dt) | {"noise_density": float(np.std(still) * math.sqrt(dt))}
