"""By the time that one pass stands for."""


def fair_step(h, iterations, other):
    return h / iterations * other
