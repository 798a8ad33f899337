"""Two cases."""


def push_out(depth, h, beta, slop):
    too_deep = depth - slop
    return too_deep * beta / h if too_deep > 0 else 0.0
