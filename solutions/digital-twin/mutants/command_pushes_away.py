"""The correction is the speed minus the target."""


def command(twin, target_speed):
    return twin["friction"] * target_speed + 1.5 * (twin["speed"] - target_speed)
