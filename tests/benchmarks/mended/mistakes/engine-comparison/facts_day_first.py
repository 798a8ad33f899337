# The day is written day first.


def engine_facts():
    return [
        {"engine": engine, "field": field, "value": value, "source": source, "as_of": "21.11.2026"}
        for engine, fields in _FACTS.items()
        for field, (value, source) in fields.items()
    ]
