"""No engine that is quick can be of an order higher than three."""

_full_order = _order


def _order(engine, omega):
    return min(_full_order(engine, omega), 3)
