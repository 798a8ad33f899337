"""Gives the cheap engine the long steps."""


def fair_step(h, iterations, other):
    return h * iterations / other
