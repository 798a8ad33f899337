"""Gives steps in a second."""


def fair_step(h, iterations, other):
    return iterations / (h * other)
