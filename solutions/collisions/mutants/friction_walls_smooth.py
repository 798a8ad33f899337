"""A body of infinite mass is smooth."""

_right = resolve_with_friction


def resolve_with_friction(ma, mb, va, vb, normal, restitution, mu):
    return _right(ma, mb, va, vb, normal, restitution, 0.0 if math.inf in (ma, mb) else mu)
