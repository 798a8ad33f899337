# The speed is the difference of the last two positions over the time between them.


_right_sync = sync


def sync(twin, z, t_measured):
    out = _right_sync(twin, z, t_measured)
    dt = out["t"] - twin["t"]
    return {**out, "speed": (z - twin["position"]) / dt} if dt > 0 else out
