"""Needs no loop for a constant force."""


def final_speed(mass, force, h, n):
    return force * h * n / mass
