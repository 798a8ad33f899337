"""The drive comes from a fixed friction."""


def command(twin, target_speed):
    return 0.5 * target_speed
