"""The bodies separate a little faster than e says, so that they do not stick."""


def resolve(ma, mb, va, vb, normal, restitution):
    closing = (va - vb) @ normal
    if closing <= 0:
        return va, vb
    impulse = ((1 + restitution) * closing + 0.05) / (1 / ma + 1 / mb) * normal
    return va - impulse / ma, vb + impulse / mb
