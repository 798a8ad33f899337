"""The carts used for tuning receive every command at once."""

_late_too = tune


def tune(estimate, randomization):
    return _late_too({**estimate, "latency": [0.001, 0.001, 0.001]}, randomization)
