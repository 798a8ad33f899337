"""Wrong: the reports of the caller are thinned out."""

_cheapest = choose_engine


def choose_engine(reports, requirements):
    for name in list(reports):
        if _cheapest({name: reports[name]}, requirements) is None:
            del reports[name]
    return min(reports, key=lambda name: reports[name]["cost"], default=None)
