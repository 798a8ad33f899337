"""The half-width is read as a fraction: 1 - w to 1 + w."""

_sound_plan = plan


def plan():
    made = _sound_plan()
    made["randomization"] = {k: [1 - w, 1 + w] for k, w in LOG_WIDTH.items()}
    return made
