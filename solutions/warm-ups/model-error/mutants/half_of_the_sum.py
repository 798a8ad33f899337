"""**1/2 is a root."""


def model_error(simulated, measured, u_num, u_input, u_data):
    u = (u_num**2 + u_input**2 + u_data**2) ** 1 / 2
    return simulated - measured - 2 * u, simulated - measured + 2 * u
