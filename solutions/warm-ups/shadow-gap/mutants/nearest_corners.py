"""The nearest two corners decide."""


def shadow_gap(a, b, direction):
    dx, dy = direction
    size = math.hypot(dx, dy)
    on_a = [(x * dx + y * dy) / size for x, y in a]
    on_b = [(x * dx + y * dy) / size for x, y in b]
    return min(abs(p - q) for p in on_a for q in on_b)
