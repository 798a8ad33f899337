"""A pose that cannot go on."""


def joint_speeds(angle, length, vx, vy):
    """How fast a carriage and the rod on it must move so that the tip has a given velocity.

    Args:
        angle: of the rod from the rail, rad, counter-clockwise.
        length: of the rod, m; positive.
        vx: velocity of the tip along the rail, m/s.
        vy: velocity of the tip across the rail, m/s.

    Returns:
        Pair of the carriage's velocity, m/s, and the rod's rate of turning, rad/s; None in a singular pose.
    """
    raise NotImplementedError
