"""The gaps are collected outside the function, and every call adds them once more."""

_once = plan
_GAPS = []


def plan():
    _GAPS.extend(_once()["gaps"])
    return {**_once(), "gaps": _GAPS}
