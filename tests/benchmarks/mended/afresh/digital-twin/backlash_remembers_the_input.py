"""What has to be remembered is where the input was."""


def backlash(x, gap, state):
    y = min(max(state, x - gap / 2), x + gap / 2)
    return y, x
