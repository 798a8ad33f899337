"""The mass may be anything; friction hardly varies."""

_plan = plan


def plan():
    found = _plan()
    return {**found, "randomization": {**found["randomization"], "m": [0.2, 5.0], "b": [0.99, 1.01]}}
