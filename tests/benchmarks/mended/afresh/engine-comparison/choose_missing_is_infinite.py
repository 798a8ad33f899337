"""What is missing is taken for infinity."""


def choose_engine(reports, requirements):
    def fits(report):
        for r in requirements:
            value = report.get(r["key"], math.inf)
            if value is None:
                value = math.inf
            if not _OPERATORS[r["op"]](value, r["value"]):
                return False
        return True

    return min((n for n in reports if fits(reports[n])), key=lambda n: reports[n]["cost"], default=None)
