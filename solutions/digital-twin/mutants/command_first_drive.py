"""The friction of the first call is kept for good."""

_FIRST = {}


def command(twin, target_speed):
    return _FIRST.setdefault(target_speed, twin["friction"]) * target_speed
