"""Half a kick on either side of the move."""


def swing(x, v, k, m, h, n):
    for _ in range(n):
        v += 0.5 * h * (-k / m * x)
        x += h * v
        v += 0.5 * h * (-k / m * x)
    return x, v
