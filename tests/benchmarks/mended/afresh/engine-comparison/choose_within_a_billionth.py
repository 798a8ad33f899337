"""'==' is tested with math.isclose for numbers instead of exactly, so a value that differs in the last
digits passes.
"""

import math


def satisfied(value, op, limit):
    if value is None:
        return False
    if op == "<=":
        return value <= limit
    if op == ">=":
        return value >= limit
    if isinstance(value, (int, float)) and isinstance(limit, (int, float)):
        return math.isclose(value, limit)
    return value == limit


def choose_engine(reports, requirements):
    fitting = []
    for name in reports:
        ok = True
        for r in requirements:
            if not satisfied(reports[name].get(r["key"]), r["op"], r["value"]):
                ok = False
                break
        if ok:
            fitting.append((reports[name]["cost"], name))
    return min(fitting)[1] if fitting else None
