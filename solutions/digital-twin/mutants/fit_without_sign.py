"""A bias is a size."""

_signed = fit_noise


def fit_noise(still, dt):
    found = _signed(still, dt)
    return {**found, "bias0": abs(found["bias0"])}
