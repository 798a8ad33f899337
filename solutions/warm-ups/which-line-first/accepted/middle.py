"""The implicit middle of the step, solved for the spring."""


def swing(x, v, k, m, h, n):
    w = 0.25 * h * h * k / m
    for _ in range(n):
        x_next = ((1 - w) * x + h * v) / (1 + w)
        v = v - 0.5 * h * k / m * (x + x_next)
        x = x_next
    return x, v
