"""Quantiles of the chi-square distribution, by bisection of the regularised incomplete gamma function."""

from __future__ import annotations

import functools
import math


def _lower_gamma(a: float, x: float) -> float:
    """P(a, x) by its power series, or 1 - Q(a, x) by Lentz's continued fraction where that is quicker."""
    if x <= 0:
        return 0.0
    scale = math.exp(a * math.log(x) - x - math.lgamma(a))
    if x < a + 1:
        term = total = 1 / a
        n = a
        while term > 1e-12 * total:
            n += 1
            term *= x / n
            total += term
        return scale * total
    b = x + 1 - a
    c, d = 1e300, 1 / b
    fraction = d
    for i in range(1, 1000):
        factor = -i * (i - a)
        b += 2
        d = 1 / (factor * d + b)
        c = b + factor / c
        fraction *= c * d
        if abs(c * d - 1) < 1e-12:
            break
    return 1 - scale * fraction


@functools.cache
def quantile(dof: int, p: float) -> float:
    """The number that a chi-square variable of ``dof`` degrees of freedom stays below with probability p."""
    low, high = 0.0, dof + 20 * math.sqrt(2 * dof) + 20
    for _ in range(36):  # to 1e-8 or so
        middle = 0.5 * (low + high)
        low, high = (middle, high) if _lower_gamma(dof / 2, middle / 2) < p else (low, middle)
    return 0.5 * (low + high)
