# A value of zero or False counts as missing.


def choose_engine(reports, requirements):
    best = None
    for name, report in reports.items():
        for need in requirements:
            value = report.get(need["key"])
            if not value:
                break
            if not _OPERATORS[need["op"]](value, need["value"]):
                break
        else:
            if best is None or report["cost"] < reports[best]["cost"]:
                best = name
    return best
