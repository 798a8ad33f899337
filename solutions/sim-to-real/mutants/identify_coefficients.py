"""The fit's coefficients are taken for the parameters: b/m and Fc/m instead of b and Fc."""

_parameters_of = identify


def identify(t, u, y):
    found = _parameters_of(t, u, y)
    m = found["m"][0]
    return {k: [x / m for x in entry] if k in ("b", "Fc") else entry for k, entry in found.items()}
