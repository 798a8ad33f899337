"""How heavy is the hand?"""


def felt_mass(carriage, tip, length, angle):
    """Mass that a wall across the rail feels when the tip of the rod hits it.

    Args:
        carriage: its mass, kg; positive.
        tip: mass at the end of the rod, kg; positive.
        length: of the rod, m; positive.
        angle: of the rod from the rail, rad.

    Returns:
        float, kg.
    """
    raise NotImplementedError
