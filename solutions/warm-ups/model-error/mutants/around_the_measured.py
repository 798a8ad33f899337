"""The interval is where the value lies."""


def model_error(simulated, measured, u_num, u_input, u_data):
    u = math.hypot(u_num, u_input, u_data)
    return measured - 2 * u, measured + 2 * u
