"""Wrong: a hit at 1 m/s, at which some engines do not rebound."""

_hit = _slow_hit


def _slow_hit(engine, info):
    start = -(info["radius"] + info["wall_thickness"] / 2) - 3.5 * info["dt"]
    q, v = engine.run("wall", [start], [1.0], info["dt"], 10, [0])
    hit = next(i for i in range(11) if v[i][0] <= 0)
    return -v[hit][0] / v[hit - 1][0], _hit(engine, info)[1]
