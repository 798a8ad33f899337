"""Takes e as a share of the energy."""


def after_floor(v, e):
    return -(e**0.5) * v if v < 0 else v
