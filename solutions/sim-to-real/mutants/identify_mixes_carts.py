"""Wrong: a little of the estimate before is mixed in, and it was another cart's."""

_right = identify
_before = {}


def identify(t, u, y):
    found = _right(t, u, y)
    for name, entry in found.items():
        shift = 0.02 * (_before.get(name, entry[0]) - entry[0])
        found[name] = [number + shift for number in entry]
        _before[name] = found[name][0]
    return found
