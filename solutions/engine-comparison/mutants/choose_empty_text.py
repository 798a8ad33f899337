"""Wrong: an empty text instead of None."""

_cheapest = choose_engine


def choose_engine(reports, requirements):
    return _cheapest(reports, requirements) or ""
