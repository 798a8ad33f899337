""" "==" between two floats is tested with a tolerance (math.isclose, relative 1e-6) instead of exactly, so
a number that is very near but not equal meets the requirement.
"""

import math


def same(a, b):
    if isinstance(a, float) and isinstance(b, float):
        return math.isclose(a, b, rel_tol=1e-6)
    return a == b


def choose_engine(reports, requirements):
    left = dict(reports)
    for req in requirements:
        key, op, wanted = req["key"], req["op"], req["value"]
        still = {}
        for name, rep in left.items():
            if key not in rep or rep[key] is None:
                continue
            have = rep[key]
            if op == "<=" and have <= wanted:
                still[name] = rep
            elif op == ">=" and have >= wanted:
                still[name] = rep
            elif op == "==" and same(have, wanted):
                still[name] = rep
        left = still
    ranking = sorted((rep["cost"], name) for name, rep in left.items())
    if not ranking:
        return None
    return ranking[0][1]
