"""A fair comparison: the model solution."""


def fair_step(h, iterations, other):
    """Step at which another engine does the same work in a simulated second."""
    return h * other / iterations
