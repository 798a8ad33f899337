"""Which line comes first?: the model solution."""


def swing(x, v, k, m, h, n):
    """A mass on a spring after n steps."""
    for _ in range(n):
        v += h * (-k / m * x)
        x += h * v
    return x, v
