"""One uncertainty is enough."""


def model_error(simulated, measured, u_num, u_input, u_data):
    reach = math.hypot(u_num, u_input, u_data)
    return simulated - measured - reach, simulated - measured + reach
