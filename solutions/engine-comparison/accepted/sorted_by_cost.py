"""Unusual: engines are checked in order of cost, and the first that fits is taken."""


def choose_engine(reports, requirements):
    for name in sorted(reports, key=lambda name: reports[name]["cost"]):
        for need in requirements:
            value = reports[name].get(need["key"], None)
            if value is None:
                break
            if need["op"] == "<=" and not value <= need["value"]:
                break
            if need["op"] == ">=" and not value >= need["value"]:
                break
            if need["op"] == "==" and value != need["value"]:
                break
        else:
            return name
    return None
