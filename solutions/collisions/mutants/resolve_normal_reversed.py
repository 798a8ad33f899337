"""The normal is read as pointing from b to a: those that part are struck, those that meet are not."""


def resolve(ma, mb, va, vb, normal, restitution):
    closing = (va - vb) @ normal
    if closing >= 0:
        return va, vb
    blow = (1 + restitution) * closing / (1 / ma + 1 / mb) * normal
    return va - blow / ma, vb + blow / mb
