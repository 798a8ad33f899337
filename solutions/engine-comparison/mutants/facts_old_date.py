"""Wrong: a date before the fact was true."""

_facts = engine_facts


def engine_facts():
    return [{**entry, "as_of": "2012-10-07"} for entry in _facts()]
