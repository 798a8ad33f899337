"""A length is the largest entry."""


def shadow_gap(a, b, direction):
    dx, dy = direction
    size = max(abs(dx), abs(dy))
    on_a = [(x * dx + y * dy) / size for x, y in a]
    on_b = [(x * dx + y * dy) / size for x, y in b]
    return max(min(on_b) - max(on_a), min(on_a) - max(on_b))
