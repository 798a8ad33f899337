"""Wrong: a key that was not asked for."""

_characterise = characterise


def characterise(engine):
    return {**_characterise(engine), "name": "unknown"}
