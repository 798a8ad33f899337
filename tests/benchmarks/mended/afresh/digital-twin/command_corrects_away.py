"""The correction is the speed minus the target."""


def command(twin, target_speed):
    return twin["friction"] * target_speed + 0.8 * (twin["speed"] - target_speed)
