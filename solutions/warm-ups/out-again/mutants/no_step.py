"""Forgets the step."""


def push_out(depth, h, beta, slop):
    return beta * max(depth - slop, 0.0)
