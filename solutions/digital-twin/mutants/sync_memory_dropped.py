"""The covariance is thrown away, so each measurement is treated as the first."""

_whole = sync


def sync(twin, z, t_measured):
    if t_measured < twin["t"]:
        return dict(twin)
    return _whole(twin, z, t_measured) | {"memory": {}}
