"""The speed before the hit is the one it was started with, from one metre away."""


def _slow_hit(engine, info):
    n = round(2.0 / info["dt"])
    q, v = engine.run("wall", [-1.0], [2.0], info["dt"], n, [0])
    hit = next((i for i in range(n + 1) if v[i][0] <= 0), n)
    return abs(v[-1][0]) / 2.0, q[hit][0]
