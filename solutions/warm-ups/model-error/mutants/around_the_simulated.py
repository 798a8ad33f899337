"""The interval is where the value lies."""


def model_error(simulated, measured, u_num, u_input, u_data):
    reach = 2 * math.hypot(u_num, u_input, u_data)
    return simulated - reach, simulated + reach
