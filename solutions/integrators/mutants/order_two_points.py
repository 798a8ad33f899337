"""Only the first and the last point count."""


def observed_order(hs, errors):
    return math.log(errors[0] / errors[-1]) / math.log(hs[0] / hs[-1])
