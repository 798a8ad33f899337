"""The promise is given in per cent."""

_as_share = plan


def plan():
    return {**_as_share(), "threshold": 94}
