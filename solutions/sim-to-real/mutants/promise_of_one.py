"""The plan promises the best possible result."""

_modest = plan


def plan():
    return {**_modest(), "threshold": 1.0}
