"""Wrong: the depth with the wrong sign."""

_characterise = characterise


def characterise(engine):
    info = engine.info()
    return {**_characterise(engine), "rest_penetration": max(0.0, _settled(engine, info)[2] - info["radius"])}
