"""A box of its own, three times as wide as any fleet, instead of the one passed in."""

_given_box = tune


def tune(estimate, randomization):
    wide = {"m": 1.05, "b": 1.5, "Fc": 0.9, "tau": 1.2, "latency": 1.2}
    return _given_box(estimate, {k: [math.exp(-w), math.exp(w)] for k, w in wide.items()})
