"""Are the shadows apart: the model solution."""

import math


def shadow_gap(a, b, direction):
    """Gap between the shadows of two shapes on a line."""
    dx, dy = direction
    size = math.hypot(dx, dy)
    on_a = [(x * dx + y * dy) / size for x, y in a]
    on_b = [(x * dx + y * dy) / size for x, y in b]
    return max(min(on_b) - max(on_a), min(on_a) - max(on_b))
