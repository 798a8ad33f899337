"""Lets it become negative."""


def push_out(depth, h, beta, slop):
    return beta / h * (depth - slop)
