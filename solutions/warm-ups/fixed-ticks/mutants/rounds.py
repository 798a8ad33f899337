"""Rounds to the nearest number of steps."""


def ticks(frame, h, left):
    account = frame + left
    steps = round(account / h)
    return steps, account - steps * h
