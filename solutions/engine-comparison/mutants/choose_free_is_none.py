"""Wrong: the cheapest so far is forgotten if it costs nothing."""


def choose_engine(reports, requirements):
    best = None
    for name, report in reports.items():
        values = [(report.get(r["key"]), r) for r in requirements]
        if not all(value is not None and _OPERATORS[r["op"]](value, r["value"]) for value, r in values):
            continue
        if best is None or not reports[best]["cost"] or report["cost"] < reports[best]["cost"]:
            best = name
    return best
