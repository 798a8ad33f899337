"""Wrong: nothing is ever repeated, not even by accident."""

_REST = {}


def _deterministic(engine, dt):
    _REST.clear()
    return True


_first_settled = _settled


def _settled(engine, info):
    if "rest" not in _REST:
        _REST["rest"] = _first_settled(engine, info)
    return _REST["rest"]


_first_hit = _slow_hit


def _slow_hit(engine, info):
    if "hit" not in _REST:
        _REST["hit"] = _first_hit(engine, info)
    return _REST["hit"]
