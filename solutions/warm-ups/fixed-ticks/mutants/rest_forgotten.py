"""Ignores what was left."""


def ticks(frame, h, left):
    steps = int(frame // h)
    return steps, frame - steps * h
