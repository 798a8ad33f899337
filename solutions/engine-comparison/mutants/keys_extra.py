"""Wrong: a key that nobody asked for."""

_characterise = characterise


def characterise(engine):
    return {**_characterise(engine), "name": "unknown"}
