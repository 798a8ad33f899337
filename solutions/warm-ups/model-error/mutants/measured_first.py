"""The sign is a matter of taste."""


def model_error(simulated, measured, u_num, u_input, u_data):
    reach = 2 * math.hypot(u_num, u_input, u_data)
    return measured - simulated - reach, measured - simulated + reach
