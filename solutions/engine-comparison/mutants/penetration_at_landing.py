"""Wrong: the deepest point of the landing instead of where it rests."""

_characterise = characterise


def characterise(engine):
    info = engine.info()
    q, _ = engine.run(
        "floor", [0, 0, info["radius"]], [0, 0, 0], info["dt"], round(5 / info["dt"]), [0, 0, 0]
    )
    deepest = max(0.0, info["radius"] - min(z for _, _, z in q))
    return {**_characterise(engine), "rest_penetration": deepest}
