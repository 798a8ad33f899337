# The drive is put into the twin that was passed in.


def command(twin, target_speed):
    twin["drive"] = twin["friction"] * target_speed
    return twin["drive"]
