"""Wrong: the body hits the wall at 20 m/s."""


def _slow_hit(engine, info):
    start = -(info["radius"] + info["wall_thickness"] / 2) - 3.5 * 20 * info["dt"]
    q, v = engine.run("wall", [start], [20.0], info["dt"], 10, [0])
    hit = next(i for i in range(11) if v[i][0] <= 0)
    return -v[hit][0] / v[hit - 1][0], q[hit][0]
