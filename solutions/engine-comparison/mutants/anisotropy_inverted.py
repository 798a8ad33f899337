"""Wrong: along x over diagonal."""

_ratio = _anisotropy


def _anisotropy(engine, info):
    return 1 / _ratio(engine, info)
