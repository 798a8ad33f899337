"""Wrong: costs are compared in tens, and of equal ones the first is taken."""

_cheapest = choose_engine


def choose_engine(reports, requirements):
    rough = {name: {**report, "cost": round(report["cost"], -1)} for name, report in reports.items()}
    return _cheapest(rough, requirements)
