"""The points are kept by their errors, so one of two with the same error is lost."""

_right = observed_order


def observed_order(hs, errors):
    points = {float(error): float(h) for h, error in zip(hs, errors)}
    return _right(list(points.values()), list(points))
