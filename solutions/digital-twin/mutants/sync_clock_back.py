"""A late measurement sets the clock back."""

_whole = sync


def sync(twin, z, t_measured):
    return _whole(twin, z, t_measured) | {"t": t_measured}
