"""kp is limited to 4 after the search."""

_free = tune


def tune(estimate, randomization):
    gains = _free(estimate, randomization)
    return {**gains, "kp": min(gains["kp"], 4.0)}
