"""The friction is kept within a tenth of where it began."""

_free = sync


def sync(twin, z, t_measured):
    new = _free(twin, z, t_measured)
    first = twin["memory"].get("first", twin["friction"])
    rows = new["memory"]["rows"].copy()
    rows[:, 5] = np.clip(rows[:, 5], 0.9 * first, 1.1 * first)
    return {**new, "friction": float(rows[-1, 5]), "memory": {"rows": rows, "first": first}}
