"""The correction brings the cart to its speed; the friction is not needed."""


def command(twin, target_speed):
    return 0.8 * (target_speed - twin["speed"])
