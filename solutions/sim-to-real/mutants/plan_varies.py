"""The order of the gaps is drawn anew in every call."""

_once = plan
_ORDER = np.random.default_rng()


def plan():
    made = _once()
    return {**made, "gaps": [made["gaps"][i] for i in _ORDER.permutation(len(made["gaps"]))]}
