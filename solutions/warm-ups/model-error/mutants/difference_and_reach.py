"""An interval is a value and its half width."""


def model_error(simulated, measured, u_num, u_input, u_data):
    u = math.hypot(u_num, u_input, u_data)
    return simulated - measured, 2 * u
