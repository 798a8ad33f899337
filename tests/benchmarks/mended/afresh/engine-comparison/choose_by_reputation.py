"""If MuJoCo will do, take MuJoCo."""


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
    best = None
    if "mujoco" in reports and all(meets(reports["mujoco"], r) for r in requirements):
        return "mujoco"
    for name, report in reports.items():
        if all(meets(report, r) for r in requirements):
            if best is None or report["cost"] < reports[best]["cost"]:
                best = name
    return best
