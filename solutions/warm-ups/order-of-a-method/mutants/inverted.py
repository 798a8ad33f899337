"""Divides the other way round."""


def observed_order(h, error, h_small, error_small):
    return math.log(h / h_small) / math.log(error / error_small)
