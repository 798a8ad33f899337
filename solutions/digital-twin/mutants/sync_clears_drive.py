"""The drive is set to zero in the twin that was passed in."""

_given = sync


def sync(twin, z, t_measured):
    out = _given(dict(twin), z, t_measured)
    twin["drive"] = 0.0
    return out
