"""The bisection searches the quantile only between 0 and 1000, so for dof*runs near or above 1000 the
quantiles end up at 1000 and the band is wrong.
"""

import math


def _chi2_cdf(x, k):
    """Regularised lower incomplete gamma function P(k/2, x/2), by its series."""
    if x <= 0:
        return 0.0
    a, h = 0.5 * k, 0.5 * x
    term = 1.0 / a
    total = term
    n = 0
    while term > total * 1e-14:
        n += 1
        term *= h / (a + n)
        total += term
    return math.exp(a * math.log(h) - h - math.lgamma(a)) * total


def _quantile(p, k):
    left, right = 0.0, 1000.0
    for _ in range(80):
        mid = 0.5 * (left + right)
        if _chi2_cdf(mid, k) < p:
            left = mid
        else:
            right = mid
    return 0.5 * (left + right)


def consistency_band(dof, runs, alpha):
    k = dof * runs
    return _quantile(alpha / 2, k) / runs, _quantile(1 - alpha / 2, k) / runs
