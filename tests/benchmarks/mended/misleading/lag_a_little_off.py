"""Every lag is wrong by 0.03 s."""

_found = best_shift


def best_shift(pairs):
    return _found(pairs) + 0.03
