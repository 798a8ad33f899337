"""Wrong: the end of the search where nothing gets through."""

_speed = _tunnelling_speed


def _tunnelling_speed(engine, info):
    return min(_speed(engine, info), 200.0)
