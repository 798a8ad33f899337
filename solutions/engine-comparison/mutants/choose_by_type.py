"""Wrong: equal values of other types are not equal."""


def choose_engine(reports, requirements):
    def meets(value, r):
        alike = r["op"] != "==" or type(value) is type(r["value"])
        return value is not None and alike and _OPERATORS[r["op"]](value, r["value"])

    fitting = [n for n in reports if all(meets(reports[n].get(r["key"]), r) for r in requirements)]
    return min(fitting, key=lambda name: reports[name]["cost"], default=None)
