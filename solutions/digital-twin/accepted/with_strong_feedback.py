"""A drive that brings the cart to its speed at 3 per second; at the target it is the balance alone."""


def command(twin, target_speed):
    return twin["friction"] * target_speed + 3.0 * (target_speed - twin["speed"])
