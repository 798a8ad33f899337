"""Wrong: a missing value meets every requirement."""


def choose_engine(reports, requirements):
    def fits(report):
        return all(
            report.get(r["key"]) is None or _OPERATORS[r["op"]](report[r["key"]], r["value"])
            for r in requirements
        )

    fitting = [name for name in reports if fits(reports[name])]
    return min(fitting, key=lambda name: reports[name]["cost"], default=None)
