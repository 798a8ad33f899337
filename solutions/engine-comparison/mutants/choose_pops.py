"""Wrong: reports are removed from the caller's dict."""

_cheapest = choose_engine


def choose_engine(reports, requirements):
    for name in list(reports):
        if _cheapest({name: reports[name]}, requirements) is None:
            del reports[name]
    return min(reports, key=lambda name: reports[name]["cost"], default=None)
