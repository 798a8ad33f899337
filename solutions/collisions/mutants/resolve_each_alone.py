"""Each body is thrown back by its own velocity, as from a wall at rest."""


def resolve(ma, mb, va, vb, normal, restitution):
    if (va - vb) @ normal <= 0:
        return va, vb
    return tuple(v - (1 + restitution) * (v @ normal) * normal for v in (va, vb))
