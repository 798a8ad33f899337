"""Takes the step and divides the energies."""


def growth(k, m, h):
    x, v = 0.3, -0.7
    before = k * x * x + m * v * v
    x, v = x + h * v, v - h * k / m * x
    return (k * x * x + m * v * v) / before
