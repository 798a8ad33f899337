"""Wrong: a negative depth where the engine keeps a margin."""

_characterise = characterise


def characterise(engine):
    info = engine.info()
    return {**_characterise(engine), "rest_penetration": info["radius"] - _settled(engine, info)[2]}
