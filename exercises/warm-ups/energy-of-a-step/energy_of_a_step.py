"""Predict the growth."""


def growth(k, m, h):
    """Factor by which an explicit Euler step multiplies a spring's energy.

    Args:
        k: stiffness, N/m.
        m: mass, kg.
        h: length of the step, s.

    Returns:
        float.
    """
    raise NotImplementedError
