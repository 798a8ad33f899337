"""A minute of bench time instead of the twenty seconds there are."""

_sound_plan = plan


def plan():
    made = _sound_plan()
    made["excitation_budget_s"] = 60.0
    return made
