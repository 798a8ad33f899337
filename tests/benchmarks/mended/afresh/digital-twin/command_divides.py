"""The drive is the speed over the friction."""


def command(twin, target_speed):
    return target_speed / twin["friction"]
