"""Wrong: a formula instead of an experiment."""


def _tunnelling_speed(engine, info):
    return (2 * info["radius"] + info["wall_thickness"]) / info["dt"]
