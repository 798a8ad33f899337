"""The order of the gaps is another one in every call."""

import itertools

_once, _calls = plan, itertools.count()


def plan():
    made, first = _once(), next(_calls) % 2
    return {**made, "gaps": made["gaps"][first:] + made["gaps"][:first]}
