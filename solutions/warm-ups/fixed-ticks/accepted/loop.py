"""Takes the steps out one at a time."""


def ticks(frame, h, left):
    account, steps = frame + left, 0
    while account >= h:
        account -= h
        steps += 1
    return steps, account
