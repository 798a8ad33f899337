"""The output covers half of the difference at each call."""


def backlash(x, gap, state):
    edge = min(max(state, x - gap / 2), x + gap / 2)
    y = state + 0.5 * (edge - state)
    return y, y
