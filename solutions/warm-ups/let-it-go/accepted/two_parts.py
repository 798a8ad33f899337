"""Motor and gravity apart."""


def angular_acceleration(torque, m, l, angle, g=9.81):
    return 3 * torque / (m * l**2) - 1.5 * g / l * math.cos(angle)
