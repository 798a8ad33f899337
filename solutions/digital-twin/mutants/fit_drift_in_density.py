"""The density is taken from the std of the whole recording, drift and all."""

_whole = fit_noise


def fit_noise(still, dt):
    return _whole(still, dt) | {"noise_density": float(np.std(still) * math.sqrt(dt))}
