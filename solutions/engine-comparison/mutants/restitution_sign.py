"""Wrong: a negative coefficient."""

_hit = _slow_hit


def _slow_hit(engine, info):
    ratio, face = _hit(engine, info)
    return -ratio, face
