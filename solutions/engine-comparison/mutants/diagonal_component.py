"""Wrong: one component of the diagonal force instead of the force."""

_ratio = _anisotropy


def _anisotropy(engine, info):
    return _ratio(engine, info) / math.sqrt(2)
