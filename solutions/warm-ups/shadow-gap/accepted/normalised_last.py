"""Divides once, at the end."""


def shadow_gap(a, b, direction):
    def shadow(shape):
        along = [x * direction[0] + y * direction[1] for x, y in shape]
        return min(along), max(along)

    (low_a, high_a), (low_b, high_b) = shadow(a), shadow(b)
    return -min(high_a - low_b, high_b - low_a) / math.hypot(*direction)
