"""Only b feels the impact."""

_right = resolve


def resolve(ma, mb, va, vb, normal, restitution):
    return va, _right(ma, mb, va, vb, normal, restitution)[1]
