"""Velocities change by J m instead of J / m."""


def resolve(ma, mb, va, vb, normal, restitution):
    blow = _impulse(ma, mb, (va - vb) @ normal, restitution) * normal
    return va - blow * ma, vb + blow * mb
