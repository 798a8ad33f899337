"""The sensor noise is measured while the cart is driven about."""

_sound_plan = plan


def plan():
    made = _sound_plan()
    made["gaps"][4]["excitation"] = "prbs"
    return made
