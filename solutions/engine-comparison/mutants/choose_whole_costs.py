"""Wrong: costs are compared in whole numbers, and of equal ones the first is taken."""

_cheapest = choose_engine


def choose_engine(reports, requirements):
    return _cheapest({name: {**r, "cost": int(r["cost"])} for name, r in reports.items()}, requirements)
