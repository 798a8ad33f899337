"""Which line comes first?"""


def swing(x, v, k, m, h, n):
    """A mass on a spring after n steps.

    Args:
        x: position at the start, m; at 0 the spring is relaxed.
        v: velocity at the start, m/s.
        k: stiffness, N/m.
        m: mass, kg.
        h: length of a step, s.
        n: number of steps.

    Returns:
        Pair of position and velocity.
    """
    for _ in range(n):
        a = -k / m * x
        x_next = x + h * v
        v_next = v + h * a
        x, v = x_next, v_next
    return x, v
