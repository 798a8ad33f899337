"""The loop as it stands in the file."""


def swing(x, v, k, m, h, n):
    for _ in range(n):
        a = -k / m * x
        x, v = x + h * v, v + h * a
    return x, v
