"""A gap leads from middle to middle."""


def shadow_gap(a, b, direction):
    dx, dy = direction
    size = math.hypot(dx, dy)
    on_a = [(x * dx + y * dy) / size for x, y in a]
    on_b = [(x * dx + y * dy) / size for x, y in b]
    return sum(on_b) / len(on_b) - sum(on_a) / len(on_a)
