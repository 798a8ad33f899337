"""Wrong: `is` stands where == belongs."""


def meets(report, requirement):
    value = report.get(requirement["key"])
    if value is None:
        return False
    if requirement["op"] == "<=":
        return value <= requirement["value"]
    if requirement["op"] == ">=":
        return value >= requirement["value"]
    return value is requirement["value"]


def choose_engine(reports, requirements):
    best = None
    for name, report in reports.items():
        if all(meets(report, r) for r in requirements):
            if best is None or report["cost"] < reports[best]["cost"]:
                best = name
    return best
