"""A threshold that every measurement meets."""

_sound_plan = plan


def plan():
    made = _sound_plan()
    made["gaps"][0]["threshold"] = 50.0
    return made
