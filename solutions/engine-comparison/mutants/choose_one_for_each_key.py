"""Wrong: of two requirements about one key the first is lost."""

_cheapest = choose_engine


def choose_engine(reports, requirements):
    return _cheapest(reports, list({r["key"]: r for r in requirements}.values()))
