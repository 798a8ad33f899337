"""Wrong: what stops a body at 100 m/s is said to stop any."""

_to_two_hundred = _tunnelling_speed


def _tunnelling_speed(engine, info):
    speed = _to_two_hundred(engine, info)
    return speed if speed < 100 else math.inf
