"""The bisection looks for quantiles up to a thousand only."""

_right_band = consistency_band


def consistency_band(dof, runs, alpha):
    return tuple(min(end, 1000.0 / runs) for end in _right_band(dof, runs, alpha))
