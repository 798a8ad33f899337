"""A threshold that sounds good: a hundredth of one per cent."""

_sound_plan = plan


def plan():
    made = _sound_plan()
    made["gaps"][1]["threshold"] = 0.01
    return made
