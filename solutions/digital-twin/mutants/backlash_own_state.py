"""The output is kept in the module; what is passed in as state counts at the start only."""

_STATE = []


def backlash(x, gap, state):
    y = min(max(_STATE[-1] if _STATE else state, x - gap / 2), x + gap / 2)
    _STATE[:] = [y]
    return y, y
