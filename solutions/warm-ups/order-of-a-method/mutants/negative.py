"""Turns one quotient round."""


def observed_order(h, error, h_small, error_small):
    return math.log(error_small / error) / math.log(h / h_small)
