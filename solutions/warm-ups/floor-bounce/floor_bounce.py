"""Only what comes in bounces: the model solution."""


def after_floor(v, e):
    """Vertical velocity after touching the floor."""
    return -e * v if v < 0 else v
