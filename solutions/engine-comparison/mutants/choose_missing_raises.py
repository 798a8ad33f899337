"""Every report has every key."""

import operator


def choose_engine(reports, requirements):
    ops = {"<=": operator.le, ">=": operator.ge, "==": operator.eq}
    fits = [
        name
        for name, report in reports.items()
        if all(ops[need["op"]](report[need["key"]], need["value"]) for need in requirements)
    ]
    return min(fits, key=lambda name: reports[name]["cost"], default=None)
