"""By the passes in a second."""


def fair_step(h, iterations, other):
    passes = iterations / h
    return other / passes
