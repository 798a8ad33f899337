"""b and Fc are swapped."""

_right_way = identify


def identify(t, u, y):
    found = _right_way(t, u, y)
    return {**found, "b": found["Fc"], "Fc": found["b"]}
