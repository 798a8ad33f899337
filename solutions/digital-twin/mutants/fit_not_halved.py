"""The Allan variance without its factor one half."""

_halved = fit_noise


def fit_noise(still, dt):
    found = _halved(still, dt)
    root = math.sqrt(2)
    return {
        **found,
        "noise_density": root * found["noise_density"],
        "bias_random_walk": root * found["bias_random_walk"],
    }
