"""Too far apart to agree?"""


def distance_in_doubts(simulated, doubt_s, measured, doubt_m):
    """Difference of two results in units of its standard deviation.

    Args:
        simulated: result of the simulation.
        doubt_s: its standard deviation, in the same unit.
        measured: result of the measurement.
        doubt_m: its standard deviation.

    Returns:
        float; never negative.
    """
    raise NotImplementedError
