"""Leaves nothing."""


def ticks(frame, h, left):
    return int((frame + left) // h), 0.0
