"""Wrong: whether an engine fits is kept under its name and the requirements, whatever its report."""

_right = choose_engine
_VERDICTS = {}


def choose_engine(reports, requirements):
    def fits(name):
        key = name, repr(requirements)
        if key not in _VERDICTS:
            _VERDICTS[key] = _right({name: reports[name]}, requirements) is not None
        return _VERDICTS[key]

    return min(filter(fits, reports), key=lambda name: reports[name]["cost"], default=None)
