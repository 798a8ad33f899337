"""Small inputs are ignored, whatever happened before."""


def backlash(x, gap, state):
    y = x - min(max(x, -gap / 2), gap / 2)
    return y, y
