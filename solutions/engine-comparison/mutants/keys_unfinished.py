"""Wrong: one key is not measured."""

_characterise = characterise


def characterise(engine):
    return {**_characterise(engine), "friction_anisotropy": None}
