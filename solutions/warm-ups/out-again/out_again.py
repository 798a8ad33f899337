"""Out again, gently: the model solution."""


def push_out(depth, h, beta, slop):
    """Separating speed that removes a share of a penetration."""
    return beta / h * max(depth - slop, 0.0)
