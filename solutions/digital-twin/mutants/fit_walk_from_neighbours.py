"""The walk is estimated from neighbouring samples."""

_whole = fit_noise


def fit_noise(still, dt):
    return _whole(still, dt) | {"bias_random_walk": float(np.std(np.diff(still)) / math.sqrt(dt))}
