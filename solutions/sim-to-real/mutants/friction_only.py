"""Three gaps, all of them from friction."""

_sound_plan = plan


def plan():
    made = _sound_plan()
    made["gaps"] = [made["gaps"][1], made["gaps"][2], {**made["gaps"][2], "excitation": "chirp"}]
    return made
