"""Wrong: the weight acts twice."""

_characterise = characterise


def characterise(engine):
    info = engine.info()
    weight = [0, 0, -info["mass"] * info["g"]]
    start = [0, 0, info["radius"]]
    q, _ = engine.run("floor", start, [0, 0, 0], info["dt"], round(5 / info["dt"]), weight)
    return {**_characterise(engine), "rest_penetration": max(0.0, info["radius"] - q[-1][2])}
