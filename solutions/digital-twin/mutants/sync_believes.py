"""The position is what was measured."""

_whole = sync


def sync(twin, z, t_measured):
    if t_measured < twin["t"]:
        return dict(twin)
    seen = {**twin, "t": t_measured, "position": z}
    if t_measured > twin["t"]:
        seen["speed"] = (z - twin["position"]) / (t_measured - twin["t"])
    return seen
