"""Subtracts the slop from the speed."""


def push_out(depth, h, beta, slop):
    return max(beta / h * depth - slop, 0.0)
