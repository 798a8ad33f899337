"""Wrong: requirements are ticked off by taking them from the list."""

_cheapest = choose_engine


def choose_engine(reports, requirements):
    left = dict(reports)
    while requirements:
        need = [requirements.pop()]
        left = {name: report for name, report in left.items() if _cheapest({name: report}, need)}
    return _cheapest(left, [])
