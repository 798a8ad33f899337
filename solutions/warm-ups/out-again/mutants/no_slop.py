"""Ignores the slop."""


def push_out(depth, h, beta, slop):
    return beta / h * max(depth, 0.0)
