"""The gains are those of the heaviest and slowest cart of the box."""

_whole_box = tune


def tune(estimate, randomization):
    return _whole_box(estimate, {k: [high, high] for k, (_, high) in randomization.items()})
