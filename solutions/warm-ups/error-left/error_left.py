"""How much error is left: the model solution."""


def error_left(coarse, fine, factor, order):
    """Error that is left in the finer of two runs, by Richardson's estimate."""
    return (coarse - fine) / (factor**order - 1)
