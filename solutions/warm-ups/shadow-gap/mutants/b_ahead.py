"""The second shape is ahead."""


def shadow_gap(a, b, direction):
    dx, dy = direction
    size = math.hypot(dx, dy)
    on_a = [(x * dx + y * dy) / size for x, y in a]
    on_b = [(x * dx + y * dy) / size for x, y in b]
    return min(on_b) - max(on_a)
