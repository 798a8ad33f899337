"""The speed of parting is e s, so the impulse that makes it is e s times the mass."""


def impulse_1d(ma, mb, va, vb, restitution):
    s = va - vb
    if s <= 0:
        return 0.0
    return restitution * s / (1 / ma + 1 / mb)
