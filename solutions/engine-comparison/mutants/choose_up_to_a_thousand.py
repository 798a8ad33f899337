"""Wrong: The search for the cheapest starts at a cost of 1000."""


def meets(report, requirement):
    value = report.get(requirement["key"])
    if value is None:
        return False
    if requirement["op"] == "<=":
        return value <= requirement["value"]
    if requirement["op"] == ">=":
        return value >= requirement["value"]
    return value == requirement["value"]


def choose_engine(reports, requirements):
    best, lowest = None, 1000
    for name, report in reports.items():
        if report["cost"] < lowest and all(meets(report, r) for r in requirements):
            best, lowest = name, report["cost"]
    return best
