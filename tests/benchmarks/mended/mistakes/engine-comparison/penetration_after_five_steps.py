# Looked at after five steps and not after five seconds.


def _settled(engine, info):
    q, _ = engine.run("floor", [0, 0, info["radius"]], [0, 0, 0], info["dt"], 5, [0, 0, 0])
    return q[-1]
