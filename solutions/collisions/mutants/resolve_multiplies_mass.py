"""Velocities change by J m instead of J / m."""


def resolve(ma, mb, va, vb, normal, restitution):
    impulse = _impulse(ma, mb, (va - vb) @ normal, restitution) * normal
    return va - impulse * ma, vb + impulse * mb
