"""A correction by ten per second: of commands every 0.1 s it leaves nothing to correct."""


def command(twin, target_speed):
    return twin["friction"] * target_speed + 10.0 * (target_speed - twin["speed"])
