"""Wrong: the first requirement decides."""

_cheapest = choose_engine


def choose_engine(reports, requirements):
    return _cheapest(reports, requirements[:1])
