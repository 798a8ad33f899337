"""The promise is a percentage."""

_as_share = plan


def plan():
    return {**_as_share(), "threshold": 94}
