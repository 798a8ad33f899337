"""The two belongs under the root."""


def model_error(simulated, measured, u_num, u_input, u_data):
    reach = math.sqrt(2 * (u_num**2 + u_input**2 + u_data**2))
    return simulated - measured - reach, simulated - measured + reach
