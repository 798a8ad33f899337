"""The lag is to be measured while a constant force acts."""

_sound_plan = plan


def plan():
    made = _sound_plan()
    made["gaps"][3]["excitation"] = "constant"
    return made
