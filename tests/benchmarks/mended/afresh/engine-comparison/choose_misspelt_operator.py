"""An operator is misspelt, and what is not known is not met."""


def choose_engine(reports, requirements):
    known = {"=<": operator.le, ">=": operator.ge, "==": operator.eq}

    def fits(report):
        for need in requirements:
            value = report.get(need["key"])
            if value is None or need["op"] not in known or not known[need["op"]](value, need["value"]):
                return False
        return True

    return min(filter(lambda n: fits(reports[n]), reports), key=lambda n: reports[n]["cost"], default=None)
