"""A norm of three."""


def model_error(simulated, measured, u_num, u_input, u_data):
    import numpy as np

    e = simulated - measured
    return e + 2 * np.linalg.norm([u_num, u_input, u_data]) * np.array([-1.0, 1.0])
