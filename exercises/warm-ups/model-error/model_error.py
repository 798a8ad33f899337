"""What does the comparison show?"""


def model_error(simulated, measured, u_num, u_input, u_data):
    """Interval in which the error of a model lies, from one comparison with an experiment.

    Args:
        simulated: value that the simulation gives.
        measured: value that the experiment gave, in the same unit.
        u_num: standard uncertainty of the step, in the same unit.
        u_input: that of the numbers that went in.
        u_data: that of the measurement.

    Returns:
        Pair of the lower and the upper end, in the same unit.
    """
    raise NotImplementedError
