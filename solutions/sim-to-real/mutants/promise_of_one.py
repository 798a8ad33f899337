"""The plan promises the best."""

_modest = plan


def plan():
    return {**_modest(), "threshold": 1.0}
