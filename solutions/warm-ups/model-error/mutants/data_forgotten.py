"""A measurement is the truth."""


def model_error(simulated, measured, u_num, u_input, u_data):
    reach = 2 * math.hypot(u_num, u_input)
    return simulated - measured - reach, simulated - measured + reach
