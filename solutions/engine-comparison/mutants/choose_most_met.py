"""Wrong: the engine that meets most requirements."""


def choose_engine(reports, requirements):
    def met(report):
        return sum(
            report.get(r["key"]) is not None and _OPERATORS[r["op"]](report[r["key"]], r["value"])
            for r in requirements
        )

    return min(reports, key=lambda name: (-met(reports[name]), reports[name]["cost"]))
