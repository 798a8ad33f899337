"""An engine with a None anywhere is left out."""


def choose_engine(reports, requirements):
    def fits(report):
        if any(value is None for value in report.values()):
            return False  # not fully measured
        return all(
            r["key"] in report and _OPERATORS[r["op"]](report[r["key"]], r["value"]) for r in requirements
        )

    return min((n for n in reports if fits(reports[n])), key=lambda n: reports[n]["cost"], default=None)
