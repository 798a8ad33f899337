"""Twice the uncertainty is the whole width."""


def model_error(simulated, measured, u_num, u_input, u_data):
    reach = 2 * math.sqrt((u_num**2 + u_input**2 + u_data**2) / 3)
    return simulated - measured - reach, simulated - measured + reach
