"""A drive that also closes what is missing of the speed; at the target it is the balance alone."""


def command(twin, target_speed):
    return twin["friction"] * target_speed + 0.6 * (target_speed - twin["speed"])
