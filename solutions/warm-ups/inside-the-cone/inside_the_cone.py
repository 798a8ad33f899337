"""Inside the cone: the model solution."""

import math


def friction(wanted, normal, mu):
    """Friction impulse within its cone."""
    most, size = mu * normal, math.hypot(*wanted)
    if size <= most:
        return list(wanted)
    return [part * most / size for part in wanted]
