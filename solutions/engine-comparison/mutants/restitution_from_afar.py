"""Wrong: the loss on the way counts as a loss at the wall."""

_hit = _slow_hit


def _slow_hit(engine, info):
    dt = info["dt"]
    speed = 2.0
    q, v = engine.run("wall", [-1.0], [speed], dt, round(0.8 / dt), [0])
    return -v[-1][0] / speed, _hit(engine, info)[1]
