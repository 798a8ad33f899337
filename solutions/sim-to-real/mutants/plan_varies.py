"""The threshold is drawn anew in every call."""

_once = plan
_CHANCE = np.random.default_rng()


def plan():
    return {**_once(), "threshold": _CHANCE.uniform(0.94, 0.95)}
