"""An error has no sign."""


def model_error(simulated, measured, u_num, u_input, u_data):
    reach = 2 * math.hypot(u_num, u_input, u_data)
    return abs(simulated - measured) - reach, abs(simulated - measured) + reach
