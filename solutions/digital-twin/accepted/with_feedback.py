"""A drive that also corrects the speed; at the target speed only the balance is left."""


def command(twin, target_speed):
    return twin["friction"] * target_speed + 0.6 * (target_speed - twin["speed"])
