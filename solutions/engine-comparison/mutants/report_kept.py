"""Wrong: a report is kept under the numbers of info(), which another engine may show as well."""

_characterise = characterise
_REPORTS = {}


def characterise(engine):
    shown = tuple(sorted(engine.info().items()))
    if shown not in _REPORTS:
        _REPORTS[shown] = _characterise(engine)
    return dict(_REPORTS[shown])
