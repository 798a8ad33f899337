"""Wrong: an entry twice."""

_facts = engine_facts


def engine_facts():
    return _facts() + [{**_facts()[0], "source": "https://ode.org"}]
