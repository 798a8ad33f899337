"""Wrong: requirements are removed from the caller's list when they have been checked."""

_cheapest = choose_engine


def choose_engine(reports, requirements):
    left = dict(reports)
    while requirements:
        need = [requirements.pop()]
        left = {name: report for name, report in left.items() if _cheapest({name: report}, need)}
    return _cheapest(left, [])
