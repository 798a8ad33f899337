"""Forgets the normal impulse."""


def friction(wanted, normal, mu):
    size = math.hypot(*wanted)
    return list(wanted) if size <= mu else [part * mu / size for part in wanted]
