"""As it stands in the file."""


def euler_step(x, v, a, h):
    v = v + h * a
    x = x + h * v
    return x, v
