"""How much error is left?"""


def error_left(coarse, fine, factor, order):
    """Error that is left in the finer of two runs, by Richardson's estimate.

    Args:
        coarse: result with the larger step.
        fine: result with the smaller step, in the same unit.
        factor: larger step over smaller step; above 1.
        order: power of the step with which the error goes; positive.

    Returns:
        float: ``fine`` minus the exact result, in the same unit.
    """
    raise NotImplementedError
