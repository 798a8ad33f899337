"""The whole slot lies behind the pin."""


def backlash(x, gap, state):
    y = min(max(state, x - gap), x)
    return y, y
