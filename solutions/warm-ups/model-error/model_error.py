"""What does the comparison show: the model solution."""

import math


def model_error(simulated, measured, u_num, u_input, u_data):
    """Interval in which the error of a model lies, from one comparison with an experiment."""
    reach = 2 * math.hypot(u_num, u_input, u_data)
    return simulated - measured - reach, simulated - measured + reach
