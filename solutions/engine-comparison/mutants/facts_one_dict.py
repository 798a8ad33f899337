"""Wrong: one dict is filled and listed twenty times."""

_right = engine_facts


def engine_facts():
    entry, listed = {}, []
    for fact in _right():
        entry.update(fact)
        listed.append(entry)
    return listed
