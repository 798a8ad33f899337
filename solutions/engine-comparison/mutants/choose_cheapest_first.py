"""Wrong: the cheapest of all, and only then the requirements."""


def choose_engine(reports, requirements):
    name = min(reports, key=lambda name: reports[name]["cost"])
    report = reports[name]
    fits = all(
        report.get(r["key"]) is not None and _OPERATORS[r["op"]](report[r["key"]], r["value"])
        for r in requirements
    )
    return name if fits else None
