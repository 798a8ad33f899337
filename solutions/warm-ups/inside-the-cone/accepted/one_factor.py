"""One factor for both cases."""


def friction(wanted, normal, mu):
    size = math.hypot(*wanted)
    factor = min(1.0, mu * normal / size) if size > 0 else 1.0
    return [factor * part for part in wanted]
