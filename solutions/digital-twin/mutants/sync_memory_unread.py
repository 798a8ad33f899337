"""The covariance is returned as memory, and the next call starts from the first one again."""

_whole = sync


def sync(twin, z, t_measured):
    if t_measured < twin["t"]:
        return dict(twin)
    return _whole({**twin, "memory": {}}, z, t_measured)
