"""Predict the growth: the model solution."""


def growth(k, m, h):
    """Factor by which an explicit Euler step multiplies a spring's energy."""
    return 1.0 + h * h * k / m
