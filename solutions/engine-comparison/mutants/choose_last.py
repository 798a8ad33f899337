"""Wrong: the last of those that fit, whatever it costs."""

_cheapest = choose_engine


def choose_engine(reports, requirements):
    fitting = [name for name in reports if _cheapest({name: reports[name]}, requirements)]
    return fitting[-1] if fitting else None
