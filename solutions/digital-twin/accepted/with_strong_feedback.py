"""A drive that corrects the speed at 3 per second; at the target speed only the balance is left."""


def command(twin, target_speed):
    return twin["friction"] * target_speed + 3.0 * (target_speed - twin["speed"])
