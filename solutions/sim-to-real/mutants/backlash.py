"""Gear backlash is listed because every list has it."""

_sound_plan = plan


def plan():
    made = _sound_plan()
    made["gaps"][4] = {**made["gaps"][4], "source": "gear_backlash", "parameter": "play"}
    return made
