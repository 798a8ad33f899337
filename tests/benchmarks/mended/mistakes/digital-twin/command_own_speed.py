# Friction on the twin's own speed and not on the target's.


def command(twin, target_speed):
    return twin["friction"] * twin["speed"] + 0.5 * (target_speed - twin["speed"])
