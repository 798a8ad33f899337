"""Turns both velocities round."""


def after_contact(v1, v2):
    return -v1, -v2
