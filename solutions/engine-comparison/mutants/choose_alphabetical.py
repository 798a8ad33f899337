"""Wrong: of those that fit, the first in the alphabet."""

_cheapest = choose_engine


def choose_engine(reports, requirements):
    return min((n for n in reports if _cheapest({n: reports[n]}, requirements)), default=None)
