"""Small inputs are swallowed wherever they come from."""


def backlash(x, gap, state):
    y = x - min(max(x, -gap / 2), gap / 2)
    return y, y
