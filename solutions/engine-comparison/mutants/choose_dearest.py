"""Wrong: the most expensive of those that fit."""

_cheapest = choose_engine


def choose_engine(reports, requirements):
    turned = {name: {**report, "cost": -report["cost"]} for name, report in reports.items()}
    return _cheapest(turned, requirements)
