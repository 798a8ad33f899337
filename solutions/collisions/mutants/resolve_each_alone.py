"""Each body rebounds with its own velocity, as if it had hit a wall at rest."""


def resolve(ma, mb, va, vb, normal, restitution):
    if (va - vb) @ normal <= 0:
        return va, vb
    return tuple(v - (1 + restitution) * (v @ normal) * normal for v in (va, vb))
