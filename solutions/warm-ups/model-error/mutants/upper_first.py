"""The order of a pair is free."""


def model_error(simulated, measured, u_num, u_input, u_data):
    reach = 2 * math.hypot(u_num, u_input, u_data)
    return simulated - measured + reach, simulated - measured - reach
