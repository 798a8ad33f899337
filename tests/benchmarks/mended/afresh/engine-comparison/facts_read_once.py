"""The rows at the top of the file are an iterator."""

_ROWS = (
    {"engine": engine, "field": field, "value": value, "source": source, "as_of": _AS_OF}
    for engine, fields in _FACTS.items()
    for field, (value, source) in fields.items()
)


def engine_facts():
    return list(_ROWS)
