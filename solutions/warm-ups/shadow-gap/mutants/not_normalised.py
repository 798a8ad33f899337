"""The length of a direction does not matter."""


def shadow_gap(a, b, direction):
    dx, dy = direction
    on_a = [x * dx + y * dy for x, y in a]
    on_b = [x * dx + y * dy for x, y in b]
    return max(min(on_b) - max(on_a), min(on_a) - max(on_b))
