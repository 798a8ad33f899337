"""The covariance lives in the module."""

_whole = sync


_memory = {}


def sync(twin, z, t_measured):
    if not twin["memory"]:
        _memory.clear()
    twin = _whole({**twin, "memory": dict(_memory)}, z, t_measured)
    _memory.update(twin["memory"])
    return {**twin, "memory": {"begun": 1}}
