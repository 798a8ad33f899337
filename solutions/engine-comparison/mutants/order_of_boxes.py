"""Wrong: the order is moved to the nearest of 1, 2 and 4."""

_measured = _order


def _order(engine, omega):
    return min((1, 2, 4), key=lambda known: abs(known - _measured(engine, omega)))
