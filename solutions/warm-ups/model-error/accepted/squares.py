"""Squares and a root."""


def model_error(simulated, measured, u_num, u_input, u_data):
    u = (u_num**2 + u_input**2 + u_data**2) ** 0.5
    e = simulated - measured
    return [e - 2 * u, e + 2 * u]
