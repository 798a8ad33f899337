"""Wrong: the depth is rounded to millimetres."""

_characterise = characterise


def characterise(engine):
    report = _characterise(engine)
    return {**report, "rest_penetration": round(float(report["rest_penetration"]), 3)}
