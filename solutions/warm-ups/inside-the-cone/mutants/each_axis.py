"""Limits each axis by itself."""


def friction(wanted, normal, mu):
    most = mu * normal
    return [max(-most, min(most, part)) for part in wanted]
