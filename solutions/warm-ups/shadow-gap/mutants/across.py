"""Light falls along the direction."""


def shadow_gap(a, b, direction):
    dx, dy = direction
    size = math.hypot(dx, dy)
    on_a = [(x * dy - y * dx) / size for x, y in a]
    on_b = [(x * dy - y * dx) / size for x, y in b]
    return max(min(on_b) - max(on_a), min(on_a) - max(on_b))
