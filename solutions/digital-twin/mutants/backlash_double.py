"""The play is a whole gap on either side."""


def backlash(x, gap, state):
    y = min(max(state, x - gap), x + gap)
    return y, y
