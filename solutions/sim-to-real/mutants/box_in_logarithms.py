"""The box contains the logarithms."""

_sound_plan = plan


def plan():
    made = _sound_plan()
    made["randomization"] = {k: [-w, w] for k, w in LOG_WIDTH.items()}
    return made
