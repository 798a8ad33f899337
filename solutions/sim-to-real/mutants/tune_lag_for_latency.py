"""The carts used for tuning have the lag as their latency, so that tau counts twice."""

_as_it_is = tune


def tune(estimate, randomization):
    return _as_it_is({**estimate, "latency": estimate["lag"]}, randomization)
