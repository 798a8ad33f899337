"""Wrong: the command of a length is kept, and u_max of the next call may be smaller."""

_design = design_excitation
_KEPT = {}


def design_excitation(budget_s, u_max, rng):
    if budget_s not in _KEPT:
        _KEPT[budget_s] = _design(budget_s, u_max, rng)
    return _KEPT[budget_s].copy()
