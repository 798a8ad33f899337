"""Wrong: two floats are equal within a relative 1e-9."""


def choose_engine(reports, requirements):
    def meets(value, r):
        if r["op"] == "==" and isinstance(value, float) and isinstance(r["value"], float):
            return math.isclose(value, r["value"])
        return value is not None and _OPERATORS[r["op"]](value, r["value"])

    fitting = [n for n in reports if all(meets(reports[n].get(r["key"]), r) for r in requirements)]
    return min(fitting, key=lambda name: reports[name]["cost"], default=None)
