"""Wrong: keys that are missing are added to the given reports."""

_cheapest = choose_engine


def choose_engine(reports, requirements):
    for report in reports.values():
        for requirement in requirements:
            report.setdefault(requirement["key"], None)
    return _cheapest(reports, requirements)
