"""Takes the larger of two numbers."""


def after_floor(v, e):
    return max(v, -e * v)
