# The pin may move a whole gap to either side.


def backlash(x, gap, state):
    if x - state > gap:
        state = x - gap
    elif state - x > gap:
        state = x + gap
    return state, state
