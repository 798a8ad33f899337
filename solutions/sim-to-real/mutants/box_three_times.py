"""The box is three times as wide as the fleet, to be safe."""

_sound_plan = plan


def plan():
    made = _sound_plan()
    made["randomization"] = {k: [math.exp(-3 * w), math.exp(3 * w)] for k, w in LOG_WIDTH.items()}
    return made
