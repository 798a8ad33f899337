"""The history is one list, which grows in the old twin's memory and is cut there."""

_given = sync


def sync(twin, z, t_measured):
    out = _given({**twin, "memory": twin["memory"].get("own", {})}, z, t_measured)
    twin["memory"].setdefault("seen", []).append([t_measured, z])
    del twin["memory"]["seen"][:-10]
    return {**out, "memory": {"own": out["memory"], "seen": list(twin["memory"]["seen"])}}
