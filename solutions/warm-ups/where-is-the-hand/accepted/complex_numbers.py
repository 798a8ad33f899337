"""Turns of complex numbers."""


def hand(a1, a2, l1, l2):
    import cmath

    end = cmath.exp(1j * a1) * (l1 + l2 * cmath.exp(1j * a2))
    return end.real, end.imag
