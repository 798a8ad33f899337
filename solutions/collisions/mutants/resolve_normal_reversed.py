"""The normal is read as pointing from b to a: bodies that separate get an impulse, others do not."""


def resolve(ma, mb, va, vb, normal, restitution):
    closing = (va - vb) @ normal
    if closing >= 0:
        return va, vb
    impulse = (1 + restitution) * closing / (1 / ma + 1 / mb) * normal
    return va - impulse / ma, vb + impulse / mb
