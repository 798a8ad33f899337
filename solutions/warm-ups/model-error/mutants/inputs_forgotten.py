"""What goes in is known."""


def model_error(simulated, measured, u_num, u_input, u_data):
    reach = 2 * math.hypot(u_num, u_data)
    return simulated - measured - reach, simulated - measured + reach
