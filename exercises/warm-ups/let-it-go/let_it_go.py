"""And if you let it go?"""


def angular_acceleration(torque, m, l, angle, g=9.81):
    """Angular acceleration of a uniform bar about its end.

    Args:
        torque: of the motor, N m.
        m: mass, kg.
        l: length, m.
        angle: above the horizontal, rad.
        g: acceleration of free fall, m/s^2.

    Returns:
        float, rad/s^2.
    """
    raise NotImplementedError
