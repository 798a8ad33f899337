"""Uncertainties add up."""


def model_error(simulated, measured, u_num, u_input, u_data):
    reach = 2 * (u_num + u_input + u_data)
    return simulated - measured - reach, simulated - measured + reach
