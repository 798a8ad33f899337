"""The caller's twin is updated in place."""

_whole = sync


def sync(twin, z, t_measured):
    twin.update(_whole(twin, z, t_measured))
    return dict(twin)
