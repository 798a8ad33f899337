"""The largest uncertainty counts."""


def model_error(simulated, measured, u_num, u_input, u_data):
    u = max(u_num, u_input, u_data)
    return simulated - measured - 2 * u, simulated - measured + 2 * u
