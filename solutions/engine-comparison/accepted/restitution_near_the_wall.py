"""Unusual: the body starts close to the wall and comes from the right; speeds, not velocities."""


def _slow_hit(engine, info):
    reach = info["radius"] + info["wall_thickness"] / 2
    q, v = engine.run("wall", [reach + 0.011], [-2.0], info["dt"], 8, [0.0])
    hit = next(i for i in range(9) if v[i][0] >= 0)
    return abs(v[hit][0]) / abs(v[hit - 1][0]), -abs(q[hit][0])
