"""Gives whatever is wanted."""


def friction(wanted, normal, mu):
    return list(wanted)
