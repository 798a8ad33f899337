"""The prediction leaves the drive out."""

_whole = sync


def sync(twin, z, t_measured):
    return _whole({**twin, "drive": 0.0}, z, t_measured) | {"drive": twin["drive"]}
