# Starts a metre away, so that a damped body arrives slower, and divides by 2 m/s.


def _slow_hit(engine, info):
    n = math.ceil(2 / (2 * info["dt"]))
    q, v = engine.run("wall", [-1.0], [2.0], info["dt"], n, [0])
    hit = next(i for i in range(n + 1) if v[i][0] <= 0)
    return -v[hit][0] / 2.0, q[hit][0]
