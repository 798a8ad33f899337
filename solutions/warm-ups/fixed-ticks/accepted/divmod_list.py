"""Divides with remainder and returns a list."""


def ticks(frame, h, left):
    steps, rest = divmod(frame + left, h)
    return [int(steps), rest]
