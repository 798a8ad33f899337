"""The correction is added to the drive that acts now."""


def command(twin, target_speed):
    return twin["drive"] + 0.5 * (target_speed - twin["speed"])
