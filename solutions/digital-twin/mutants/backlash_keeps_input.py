"""The input is returned as the state."""


def backlash(x, gap, state):
    return min(max(state, x - gap / 2), x + gap / 2), x
