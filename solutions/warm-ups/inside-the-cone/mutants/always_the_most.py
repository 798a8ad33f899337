"""Always gives the most."""


def friction(wanted, normal, mu):
    most, size = mu * normal, math.hypot(*wanted)
    return [part * most / size if size else 0.0 for part in wanted]
