"""A fair comparison."""


def fair_step(h, iterations, other):
    """Step at which another engine does the same work in a simulated second.

    Args:
        h: step of the first engine, s.
        iterations: its iterations in each step.
        other: iterations of the other engine in each step.

    Returns:
        float, s.
    """
    raise NotImplementedError
