"""The drive is limited to 1 m/s² either way, to spare the motors."""


def command(twin, target_speed):
    return min(max(twin["friction"] * target_speed, -1.0), 1.0)
