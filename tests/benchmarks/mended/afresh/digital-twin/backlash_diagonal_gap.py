"""Half a gap is the gap over the root of two."""


def backlash(x, gap, state):
    """Output of a gear with play: it rests until the input has crossed the gap."""
    y = min(max(state, x - gap / math.sqrt(2)), x + gap / math.sqrt(2))
    return y, y
