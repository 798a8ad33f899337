"""Two is really 1.96."""


def model_error(simulated, measured, u_num, u_input, u_data):
    u = math.hypot(u_num, u_input, u_data)
    return simulated - measured - 1.96 * u, simulated - measured + 1.96 * u
