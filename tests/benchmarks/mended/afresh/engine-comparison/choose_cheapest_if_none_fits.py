"""If nothing fits, take the cheapest all the same."""


def choose_engine(reports, requirements):
    def meets(report):
        for r in requirements:
            value = report.get(r["key"])
            if value is None:
                return False
            if r["op"] == "<=" and not value <= r["value"]:
                return False
            if r["op"] == ">=" and not value >= r["value"]:
                return False
            if r["op"] == "==" and not value == r["value"]:
                return False
        return True

    fit = {name: r for name, r in reports.items() if meets(r)}
    if not fit:
        fit = reports
    return min(fit, key=lambda name: fit[name]["cost"])
