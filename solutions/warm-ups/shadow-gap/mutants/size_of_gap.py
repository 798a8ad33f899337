"""A distance has no sign."""


def shadow_gap(a, b, direction):
    dx, dy = direction
    size = math.hypot(dx, dy)
    on_a = [(x * dx + y * dy) / size for x, y in a]
    on_b = [(x * dx + y * dy) / size for x, y in b]
    return abs(max(min(on_b) - max(on_a), min(on_a) - max(on_b)))
