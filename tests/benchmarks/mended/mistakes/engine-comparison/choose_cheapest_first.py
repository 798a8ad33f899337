# The cheapest of all is taken, and then asked whether it fits.


def choose_engine(reports, requirements):
    name = min(reports, key=lambda name: reports[name]["cost"], default=None)
    if name is None:
        return None
    for need in requirements:
        value = reports[name].get(need["key"])
        if value is None or not _OPERATORS[need["op"]](value, need["value"]):
            return None
    return name
