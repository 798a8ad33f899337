"""How long does it fall?"""


def fall_time(height, g=9.81):
    """Time of a fall from rest, without air.

    Args:
        height: above the ground, m.
        g: acceleration of free fall, m/s^2.

    Returns:
        float, s.
    """
    raise NotImplementedError
