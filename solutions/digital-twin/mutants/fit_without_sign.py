"""The absolute value of the bias is returned."""

_signed = fit_noise


def fit_noise(still, dt):
    found = _signed(still, dt)
    return {**found, "bias0": abs(found["bias0"])}
