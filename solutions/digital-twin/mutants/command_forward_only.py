"""The absolute value of the target speed is used, without its sign."""


def command(twin, target_speed):
    return twin["friction"] * abs(target_speed)
