# What was not measured counts as zero.


def choose_engine(reports, requirements):
    best = None
    for name, report in reports.items():
        fits = all(_OPERATORS[r["op"]](report.get(r["key"]) or 0, r["value"]) for r in requirements)
        if fits and (best is None or report["cost"] < reports[best]["cost"]):
            best = name
    return best
