"""The moment of inertia by the parallel axis theorem."""


def angular_acceleration(torque, m, l, angle, g=9.81):
    inertia = m * l**2 / 12 + m * (l / 2) ** 2
    gravity = -m * g * l / 2 * math.cos(angle)
    return (torque + gravity) / inertia
