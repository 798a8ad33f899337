"""The target is divided by the friction."""


def command(twin, target_speed):
    return target_speed / twin["friction"]
