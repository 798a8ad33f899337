"""The drive holds the speed that the robot has now."""


def command(twin, target_speed):
    return twin["friction"] * twin["speed"]
