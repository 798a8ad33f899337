"""The stronger the correction, the sooner the cart has its speed."""


def command(twin, target_speed):
    return twin["friction"] * target_speed + 30.0 * (target_speed - twin["speed"])
