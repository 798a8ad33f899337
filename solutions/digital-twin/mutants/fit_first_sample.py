"""bias0 is the first sample."""

_whole = fit_noise


def fit_noise(still, dt):
    return _whole(still, dt) | {"bias0": float(still[0])}
