"""What does it take to hold it?"""


def holding_torque(m, l, angle, g=9.81):
    """Torque that holds a uniform bar still.

    Args:
        m: mass, kg.
        l: length, m.
        angle: above the horizontal, rad.
        g: acceleration of free fall, m/s^2.

    Returns:
        float, N m.
    """
    raise NotImplementedError
