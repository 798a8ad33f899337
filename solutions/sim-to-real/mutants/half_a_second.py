"""Half a second on the bench, because bench time is expensive."""

_sound_plan = plan


def plan():
    made = _sound_plan()
    made["excitation_budget_s"] = 0.5
    return made
