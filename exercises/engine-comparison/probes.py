"""What wrong values of a report, and the runs they were made with, have in common.

A probe looks at every engine that has a report, at those whose value is right as well. Which known program
would have reported just these values is looked up in a table (``questions.py``); a probe is for the rest.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from course.grading import kit

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    Probe = Callable[[str, list[Any]], bool]

bench = kit.companion("engine-comparison", "bench")

named = kit.words("engine-comparison")

#: key: (relative tolerance, absolute tolerance, unit, where they come from)
TOLERANCES: dict[str, tuple[float, float, str, str]] = {
    "linear_damping": (
        0.005,
        0.001,
        "1/s",
        "half of what the step's own error at dt is on the tamest engine",
    ),
    "max_stable_step": (0.01, 0.0, "s", "the contract's 1 %"),
    "friction_anisotropy": (0.03, 0.0, "1", "forces to 1 % each; the kinds of cone lie 29 % apart or more"),
    "rest_penetration": (0.03, 2e-5, "m", "what is left of the settling after 5 s is below 1e-9 m"),
    "restitution": (0.0, 0.03, "1", "one step's damping more or less counts for up to 0.025"),
    "tunnelling_speed": (0.05, 0.0, "m/s", "the contract's 5 %: 32 starts for each speed leave 3 %"),
}


def of_key(key: str, cases: list[Any]) -> Any:
    """The diagnosis of the values that were reported under ``key``, or None.

    Args:
        cases: every engine that has a report, with ``case.measured(key)`` a number or a bool.
    """
    with np.errstate(all="ignore"):
        return next((named(code) for code, looks in _PROBES[key] if looks(key, cases)), None)


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


def _where(concerned: Callable[[Any], bool], looks: Callable[[Any, Any], bool] = lambda *_: True) -> Probe:
    """Exactly the engines that are ``concerned`` are wrong, and their values look so."""

    def probe(key: str, cases: list[Any]) -> bool:
        wrong = [case for case in cases if not right(key, case)]
        return all(concerned(case) and looks(case.measured(key), case.truth[key]) for case in wrong) and all(
            case in wrong for case in cases if concerned(case)
        )

    return probe


def _both(*looks: Probe) -> Probe:
    return lambda key, cases: all(look(key, cases) for look in looks)


def _always(value: bool) -> Probe:
    return lambda key, cases: all(case.measured(key) is value for case in cases)


def _near(value: float, wrong: float, rel: float) -> bool:
    return math.isfinite(value) and math.fabs(value - wrong) <= rel * math.fabs(wrong)


def _runs(cases: list[Any], *scenes: str) -> Iterator[tuple[Any, Any]]:
    """(case, run) of every run in these scenes."""
    return ((case, run) for case in cases for run in case.runs if run[0] in scenes)


# -- what the engines are like ----------------------------------------------------------------------------


def _damped(case: Any) -> bool:
    return bool(case.box.damping > 0)


def _soft(case: Any) -> bool:
    return bool(case.box.softness > 0)


def _creeps(case: Any) -> bool:
    return bool(case.box.creep > 0)


def _spectral_radius(case: Any, z: float) -> float:
    a, b, _, c, d, _ = case.box.matrix(case.box.omega, z / case.box.omega)
    return float(max(abs(np.linalg.eigvals([[a, b * case.box.omega], [c / case.box.omega, d]]))))


def _determinant(case: Any) -> float:
    a, b, _, c, d, _ = case.box.matrix(case.box.omega, 0.5 / case.box.omega)
    return float(a * d - b * c)


def _keeps_area(case: Any) -> bool:
    return abs(_determinant(case) - 1) < 1e-6


def _recovers(case: Any) -> bool:
    """Whether stable steps follow the first unstable one, within the range of the search."""
    limit = case.truth["max_stable_step"] * case.box.omega
    if not 0 < limit < 10:
        return False
    return any(_spectral_radius(case, z) <= 1 + 1e-8 for z in np.arange(limit + 0.2, 10, 0.1))


# -- order ------------------------------------------------------------------------------------------------


def _one_for_all(key: str, cases: list[Any]) -> bool:
    return len({case.measured(key) for case in cases}) == 1 < len({case.truth[key] for case in cases})


def _flattered(key: str, cases: list[Any]) -> bool:
    """Wrong values are up to two too high, those of first-order engines that keep area among them, and runs
    were made that start at rest or in the middle, or end after whole half-turns."""
    wrong = [case for case in cases if not right(key, case)]
    special = any(
        n > 2 and (not any(q0) or not any(v0) or _half_turns(n * h * case.box.omega))
        for case, (_, q0, v0, h, n, _) in _runs(cases, "spring")
    )
    return (
        special
        and all(case.truth[key] < case.measured(key) <= case.truth[key] + 2 for case in wrong)
        and all(case in wrong for case in cases if case.truth["order"] == 1 and _keeps_area(case))
    )


def _half_turns(angle: float) -> bool:
    return abs(angle / math.pi - round(angle / math.pi)) < 1e-3


def _tiny_steps(_: str, cases: list[Any]) -> bool:
    """On the spring, runs were made whose differences are lost in rounding for a method of fourth order."""
    return any(n > 2 and h * c.box.omega < 0.005 for c, (_, _, _, h, n, _) in _runs(cases, "spring"))


# -- symplectic -------------------------------------------------------------------------------------------


def _tiny_single_step(_: str, cases: list[Any]) -> bool:
    """Single steps of the spring were far smaller than asked for, and none was h omega = 0.5."""
    z = [h * c.box.omega for c, (_, _, _, h, n, _) in _runs(cases, "spring") if n == 1]
    return any(x < 0.04 for x in z) and not any(math.isclose(x, 0.5, rel_tol=1e-6) for x in z)


def _passes(which: Callable[[Any], bool]) -> Probe:
    return lambda key, cases: all(case.measured(key) == which(case) for case in cases)


# -- damping ----------------------------------------------------------------------------------------------


def _by_own_time(wrong: Callable[[float, float, int], float]) -> Probe:
    """Damped engines get what ``wrong(rate, h, n)`` makes of a run of a free body, others are right."""

    def looks(key: str, case: Any) -> bool:
        times = {(h, n) for _, (_, _, v0, h, n, force) in _runs([case], "free") if any(v0) and not any(force)}
        values = [wrong(case.truth[key], h, n) for h, n in times]
        return any(_near(case.measured(key), x, 0.005) for x in values if not _near(case.truth[key], x, 0.02))

    def probe(key: str, cases: list[Any]) -> bool:
        damped = [case for case in cases if _damped(case)]
        others = (case for case in cases if case not in damped)
        return bool(damped) and all(right(key, c) for c in others) and all(looks(key, c) for c in damped)

    return probe


def _where_damped(looks: Callable[[float, float], bool]) -> Probe:
    """The values of damped engines look so, whatever the others are."""

    def probe(key: str, cases: list[Any]) -> bool:
        damped = [case for case in cases if _damped(case)]
        return bool(damped) and all(looks(case.measured(key), case.truth[key]) for case in damped)

    return probe


# -- the largest stable step ------------------------------------------------------------------------------


def _no_zero(key: str, cases: list[Any]) -> bool:
    """Engines that are never stable get a limit, and the others are right or nearly so."""
    never = [case for case in cases if case.truth[key] == 0]
    rest = [case for case in cases if case.truth[key] > 0]
    return any(case.measured(key) > 0 for case in never) and all(
        right(key, case) or _near(case.measured(key), case.truth[key], 0.2) for case in rest
    )


def _coarse(key: str, cases: list[Any]) -> bool:
    """All are close: within a fifth, or a step of the search."""
    return all(
        right(key, c)
        or (
            0 < c.truth[key] < math.inf
            and math.fabs(c.measured(key) - c.truth[key]) <= max(0.2 * c.truth[key], 0.06 / c.box.omega)
        )
        for c in cases
    )


# -- floor and wall ---------------------------------------------------------------------------------------


def _pushed_at_once(_: str, cases: list[Any]) -> bool:
    """Every push on the floor began where the body just touches."""
    starts = [q0[2] - c.box.radius for c, (_, q0, _, _, _, force) in _runs(cases, "floor") if any(force)]
    return bool(starts) and all(height > -1e-6 for height in starts)


def _pushes(case: Any) -> list[float]:
    """How hard the body on the floor was pushed in each run, in units of mu m g; pushes alone."""
    weight = case.box.mu * case.box.mass * case.box.g
    return [math.hypot(*force[:2]) / weight for *_, force in case.runs if len(force) == 3 and any(force)]


def _pushed_softly(_: str, cases: list[Any]) -> bool:
    """No push was harder than mu m g."""
    pushes = [push for case in cases for push in _pushes(case)]
    return bool(pushes) and max(pushes) < 1.05


def _pushed_seldom(_: str, cases: list[Any]) -> bool:
    """Too few pushes for two forces between 0 and 5 mu m g to 3 %: that takes seven halvings each."""
    return all(0 < len(set(_pushes(case))) < 14 for case in cases)


def _never_free(_: str, cases: list[Any]) -> bool:
    """No run was made in the scene "free"."""
    return any(case.runs for case in cases) and not any(True for _ in _runs(cases, "free"))


def _dropped(_: str, cases: list[Any]) -> bool:
    """Every run on the floor without a push began above it."""
    starts = [q0[2] - c.box.radius for c, (_, q0, _, _, _, force) in _runs(cases, "floor") if not any(force)]
    return bool(starts) and all(height > 1e-3 for height in starts)


def _other_step(scene: str, counts: Callable[[Any], bool] = lambda _: True) -> Probe:
    """Every run of that kind was made with another step than the engine's own."""

    def probe(_: str, cases: list[Any]) -> bool:
        steps = [
            math.isclose(run[3], c.box.dt, rel_tol=1e-6) for c, run in _runs(cases, scene) if counts(run)
        ]
        return bool(steps) and not any(steps)

    return probe


def _from_afar(_: str, cases: list[Any]) -> bool:
    """Runs at the wall with 2 m/s began half a metre away or more, and none began nearer."""
    starts = [
        abs(q0[0]) - c.box.radius
        for c, (_, q0, v0, _, _, _) in _runs(cases, "wall")
        if 1.99 < abs(v0[0]) < 2.6 and abs(q0[0]) > 0
    ]
    return bool(starts) and min(starts) > 0.5


def _one_start(_: str, cases: list[Any]) -> bool:
    """Hardly any speed was tried from more than one place."""
    return (
        _share_of_speeds(cases, bool) > 0 and _share_of_speeds(cases, lambda places: len(places) > 1) <= 0.2
    )


def _several_starts(_: str, cases: list[Any]) -> bool:
    return _share_of_speeds(cases, lambda places: len(places) > 1) >= 0.5


def _share_of_speeds(cases: list[Any], looks: Callable[[set[Any]], bool]) -> float:
    starts: dict[Any, set[Any]] = {}
    for case, (_, q0, v0, *_) in _runs(cases, "wall"):
        starts.setdefault((case.name, v0), set()).add(q0)
    return sum(map(looks, starts.values())) / max(1, len(starts))


def _too_high(most: float) -> Probe:
    """Wrong values are too high, finite, and up to so many times the right ones."""

    def probe(key: str, cases: list[Any]) -> bool:
        wrong = [case for case in cases if not right(key, case)]
        return all(
            math.isfinite(case.measured(key))
            and case.truth[key] < case.measured(key) <= most * case.truth[key]
            for case in wrong
        )

    return probe


def _infinite(key: str, cases: list[Any]) -> bool:
    """Some value is infinite where the right one is not, and every other wrong one is too high."""
    wrong = [case for case in cases if not right(key, case)]
    return any(math.isinf(case.measured(key)) for case in wrong) and all(
        case.measured(key) > case.truth[key] for case in wrong
    )


def _endless(key: str) -> Callable[[Any], bool]:
    return lambda case: math.isinf(case.truth[key])


# -- repeating --------------------------------------------------------------------------------------------


def _repeated(how: int) -> Probe:
    """Every engine is called deterministic, and runs were made twice in a row like this."""
    return lambda key, cases: _always(True)(key, cases) and max(map(bench.repeated, cases)) == how


_PROBES: dict[str, list[tuple[str, Probe]]] = {
    "order": [
        ("ORDER_ASSUMED", _one_for_all),
        ("ORDER_AGAINST_UNDAMPED", _where(_damped, lambda value, t: -1 <= value < t)),
        (
            "ORDER_IN_ROUNDING",
            _both(_where(lambda case: case.truth["order"] == 4, lambda value, t: value < t), _tiny_steps),
        ),
        ("ORDER_AT_TURNING_POINT", _flattered),
    ],
    "symplectic": [
        ("SYMPLECTIC_NEVER", _always(False)),
        ("STABLE_TAKEN_FOR_SYMPLECTIC", _passes(lambda case: _determinant(case) <= 1 + 1e-6)),
        ("STABLE_TAKEN_FOR_SYMPLECTIC", _passes(lambda case: _spectral_radius(case, 0.5) <= 1 + 1e-6)),
        (
            "SYMPLECTIC_STEP_TOO_SMALL",
            _both(
                _tiny_single_step, lambda key, cases: all(c.measured(key) for c in cases if _keeps_area(c))
            ),
        ),
    ],
    "linear_damping": [
        ("DAMPING_ASSUMED", lambda key, cases: all(case.measured(key) == 0 for case in cases)),
        ("DAMPING_OTHER_SCENE", _never_free),
        ("DAMPING_NOT_LOG", _by_own_time(lambda c, h, n: (1 - math.exp(-c * n * h)) / (n * h))),
        ("DAMPING_NOT_LOG", _by_own_time(lambda c, h, n: 1 - math.exp(-c * n * h))),
        ("DAMPING_PER_STEP", _by_own_time(lambda c, h, n: c * h)),
        ("DAMPING_PER_STEP", _by_own_time(lambda c, h, n: c * h * n)),
        ("DAMPING_TIME_CONSTANT", _where_damped(lambda value, c: _near(value, 1 / c, 0.01))),
        ("DAMPING_OVER_ONE_STEP", _by_own_time(lambda c, h, n: c * n)),
    ],
    "max_stable_step": [
        ("TOLERANCE_TOO_TIGHT", _where(_keeps_area, lambda value, t: value < 0.9 * t)),
        ("LIMIT_FROM_ABOVE", _where(_recovers, lambda value, t: value > t)),
        ("LIMIT_NEVER_SEEN", _infinite),
        ("NO_ZERO", _no_zero),
        ("NO_INFINITY", _where(_endless("max_stable_step"), lambda value, _: value > 0)),
        ("LIMIT_COARSE", _coarse),
    ],
    "friction_anisotropy": [
        ("ANISOTROPY_ASSUMED", lambda key, cases: all(case.measured(key) == 1 for case in cases)),
        ("OTHER_STEP_THAN_DT", _other_step("floor", lambda run: any(run[5]))),
        ("PUSHED_TOO_SOFTLY", _pushed_softly),
        ("PUSHED_TOO_SELDOM", _pushed_seldom),
        (
            "CREEP_TAKEN_FOR_SLIP",
            _where(_creeps, lambda value, _: not math.isfinite(value) or 0.9 < value < 1.1),
        ),
        ("NOT_SETTLED", _both(_where(_soft), _pushed_at_once)),
    ],
    "rest_penetration": [
        ("OTHER_STEP_THAN_DT", _other_step("floor", lambda run: not any(run[5]))),
        # A body that is put down goes at most twice as deep as it comes to rest.
        ("PENETRATION_TOO_EARLY", _where(_soft, lambda value, t: 1.03 * t < value <= 2.1 * t)),
        ("PENETRATION_TOO_EARLY", _both(_where(_soft, lambda value, t: 1.03 * t < value < 0.1), _dropped)),
    ],
    "restitution": [
        (
            "RESTITUTION_OTHER_SPEED",
            _where(lambda c: c.box.bounce_threshold > 0, lambda value, _: value == 0),
        ),
        ("RESTITUTION_WITH_DRAG", _both(_where(_damped, lambda value, t: value < t), _from_afar)),
    ],
    "tunnelling_speed": [
        ("OTHER_STEP_THAN_DT", _other_step("wall", lambda run: abs(run[2][0]) > 2.5)),
        ("TUNNEL_NO_INFINITY", _where(_endless("tunnelling_speed"), lambda value, _: value >= 0)),
        ("TUNNEL_ONE_START", _both(_too_high(math.inf), _one_start)),
        ("TUNNEL_FEW_STARTS", _both(_too_high(1.5), _several_starts)),
        ("TUNNEL_NEVER_SEEN", _infinite),
    ],
    "deterministic": [
        ("DETERMINISM_ONE_RUN", _repeated(0)),
        ("DETERMINISM_AT_REST", _repeated(1)),
        ("DETERMINISM_NOT_COMPARED", _repeated(2)),
        ("DETERMINISM_OTHER_RUN", _always(False)),
    ],
}
