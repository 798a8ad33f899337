"""Wrong: the damping is kept under the numbers of info(), which another engine may show as well."""

_characterise = characterise
_RATES = {}


def characterise(engine):
    report = _characterise(engine)
    rate = _RATES.setdefault(tuple(engine.info().values()), report["linear_damping"])
    return {**report, "linear_damping": rate}
