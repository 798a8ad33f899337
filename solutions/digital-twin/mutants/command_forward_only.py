"""The size of the target speed counts, not its sign."""


def command(twin, target_speed):
    return twin["friction"] * abs(target_speed)
