"""Wrong: the body is pushed before it has settled."""

_at_rest = _settled
_ratio = _anisotropy


def _anisotropy(engine, info):
    global _settled

    def _settled(engine, info):
        return [0.0, 0.0, info["radius"]]

    try:
        return _ratio(engine, info)
    finally:
        _settled = _at_rest
