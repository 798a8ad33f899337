"""Wrong: the first of those that fit, whatever it costs."""

_cheapest = choose_engine


def choose_engine(reports, requirements):
    equal = {name: {**report, "cost": 0.0} for name, report in reports.items()}
    return _cheapest(equal, requirements)
