"""A coefficient above one is taken for a typing error."""

_right_friction = resolve_with_friction


def resolve_with_friction(ma, mb, va, vb, normal, restitution, mu):
    return _right_friction(ma, mb, va, vb, normal, restitution, min(mu, 1.0))
