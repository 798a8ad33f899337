"""What the probes of ``engine-comparison`` share: what counts as right, and what engines are like."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    Probe = Callable[[str, list[Any]], bool]

#: key: (relative tolerance, absolute tolerance, unit, where they come from)
TOLERANCES: dict[str, tuple[float, float, str, str]] = {
    "linear_damping": (
        0.005,
        0.001,
        "1/s",
        "the README's tolerance",
    ),
    "max_stable_step": (0.01, 0.0, "s", "the README's 1 %"),
    "friction_anisotropy": (0.03, 0.0, "1", "the README's 3 %"),
    "rest_penetration": (0.03, 2e-5, "m", "the README's tolerance"),
    "restitution": (0.0, 0.03, "1", "one step's damping more or less does not matter"),
    "tunnelling_speed": (0.05, 0.0, "m/s", "the README's 5 %: 32 starts for each speed leave 3 %"),
}


def right(key: str, case: Any) -> bool:
    """Whether the value under ``key`` is accepted."""
    value, truth = case.measured(key), case.truth[key]
    if key not in TOLERANCES:
        return bool(value == truth)
    rel, abs_, _, _ = TOLERANCES[key]
    if math.isinf(truth):
        return bool(value == truth)
    return math.fabs(value - truth) <= abs_ + rel * math.fabs(truth)


# -- kinds of probe ---------------------------------------------------------------------------------------


def where(concerned: Callable[[Any], bool], looks: Callable[[Any, Any], bool] = lambda *_: True) -> Probe:
    """Exactly the engines that are ``concerned`` are wrong, and their values look so."""

    def probe(key: str, cases: list[Any]) -> bool:
        wrong = [case for case in cases if not right(key, case)]
        return all(concerned(case) and looks(case.measured(key), case.truth[key]) for case in wrong) and all(
            case in wrong for case in cases if concerned(case)
        )

    return probe


def both(*looks: Probe) -> Probe:
    return lambda key, cases: all(look(key, cases) for look in looks)


def always(value: bool) -> Probe:
    return lambda key, cases: all(case.measured(key) is value for case in cases)


def near(value: float, wrong: float, rel: float) -> bool:
    return math.isfinite(value) and math.fabs(value - wrong) <= rel * math.fabs(wrong)


def runs(cases: list[Any], *scenes: str) -> Iterator[tuple[Any, Any]]:
    """(case, run) of every run in these scenes."""
    return ((case, run) for case in cases for run in case.runs if run[0] in scenes)


# -- what the engines are like ----------------------------------------------------------------------------


def damped(case: Any) -> bool:
    return bool(case.box.damping > 0)


def soft(case: Any) -> bool:
    return bool(case.box.softness > 0)


def creeps(case: Any) -> bool:
    return bool(case.box.creep > 0)


def spectral_radius(case: Any, z: float) -> float:
    a, b, _, c, d, _ = case.box.matrix(case.box.omega, z / case.box.omega)
    return float(max(abs(np.linalg.eigvals([[a, b * case.box.omega], [c / case.box.omega, d]]))))


def determinant(case: Any, z: float = 0.5) -> float:
    a, b, _, c, d, _ = case.box.matrix(case.box.omega, z / case.box.omega)
    return float(a * d - b * c)


def keeps_area(case: Any) -> bool:
    return abs(determinant(case) - 1) < 1e-6


def recovers(case: Any) -> bool:
    """Whether stable steps follow the first unstable one, within the range of the search."""
    limit = case.truth["max_stable_step"] * case.box.omega
    if not 0 < limit < 10:
        return False
    return any(spectral_radius(case, z) <= 1 + 1e-8 for z in np.arange(limit + 0.2, 10, 0.1))


def infinite(key: str, cases: list[Any]) -> bool:
    """Some value is infinite where the right one is not, and every other wrong one is too high."""
    wrong = [case for case in cases if not right(key, case)]
    return any(math.isinf(case.measured(key)) for case in wrong) and all(
        case.measured(key) > case.truth[key] for case in wrong
    )


def some_infinite(key: str, cases: list[Any]) -> bool:
    """Some value is infinite where the right one is not, whatever the other wrong ones are."""
    return any(case.measured(key) == math.inf != case.truth[key] for case in cases)


def endless(key: str) -> Callable[[Any], bool]:
    return lambda case: math.isinf(case.truth[key])


def rounded(key: str, cases: list[Any]) -> bool:
    """Every value has the same few decimals, and the wrong ones are the right ones to as many.

    Whole numbers do not count: a ratio of 1 and a coefficient of 0 come from other mistakes as well.
    """
    values = [case.measured(key) for case in cases]
    wrong = [case for case in cases if not right(key, case)]
    return any(case.measured(key) for case in wrong) and any(
        all(math.isinf(value) or value == round(value, digits) for value in values)
        and all(math.fabs(c.measured(key) - c.truth[key]) <= 0.501 * 10.0**-digits for c in wrong)
        for digits in range(1, 5)
    )
