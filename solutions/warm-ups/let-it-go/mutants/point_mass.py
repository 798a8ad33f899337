"""Takes all the mass at the end."""


def angular_acceleration(torque, m, l, angle, g=9.81):
    return (torque - 0.5 * m * g * l * math.cos(angle)) / (m * l * l)
