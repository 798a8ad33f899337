"""Wrong: every call adds the facts to the same list, and returns what is in it."""

_once = engine_facts
_listed = []


def engine_facts():
    _listed.extend(_once())
    return list(_listed)
