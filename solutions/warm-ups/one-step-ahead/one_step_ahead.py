"""One step ahead: the model solution."""


def step_ahead(x, v, a, h):
    """Position and velocity a step later, with everything taken as constant."""
    return x + h * v, v + h * a
