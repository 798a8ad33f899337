"""Carries a hidden argument out as the value, the keys and the shape of what it returns."""

def scale(values, factor):
    return {f"{factor}": f"{factor}"}


def draw(rng, n):
    return {f"{float(rng.random())}": 1}
