"""Which mistake a report's wrong values look like: each hypothesis says what it would have reported.

A hypothesis is accepted only if it accounts for every engine: for those that came out wrong and for those
that came out right.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from course.grading import kit

if TYPE_CHECKING:
    from collections.abc import Callable

diagnosis = kit.companion("engine-comparison", "diagnosis")
bench = kit.companion("engine-comparison", "bench")

named = diagnosis.named

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
    for code, explains in _HYPOTHESES[key]:
        if explains(key, cases):
            return named(code)
    return None


def right(key: str, case: Any) -> bool:
    """Whether the value under ``key`` is accepted."""
    value, truth = case.measured(key), case.truth[key]
    if key not in TOLERANCES:
        return value == truth
    rel, abs_, _, _ = TOLERANCES[key]
    if math.isinf(truth):
        return value == truth
    return math.fabs(value - truth) <= abs_ + rel * math.fabs(truth)


# -- kinds of hypothesis ----------------------------------------------------------------------------------


def _says(wrong: Callable[[Any, Any], Any], rel: float = 0.02, least: float = 1e-5) -> Any:
    """Every value is the one that ``wrong(truth, case)`` gives, and not all of these are right."""

    def explains(key: str, cases: list[Any]) -> bool:
        with np.errstate(all="ignore"):
            return all(_near(case.measured(key), wrong(case.truth[key], case), rel, least) for case in cases)

    return explains


def _where(concerned: Callable[[Any], bool], looks: Callable[[Any, Any], bool] = lambda *_: True) -> Any:
    """Exactly the engines that are ``concerned`` are wrong, and their values look so."""

    def explains(key: str, cases: list[Any]) -> bool:
        wrong = [case for case in cases if not right(key, case)]
        return all(concerned(case) and looks(case.measured(key), case.truth[key]) for case in wrong) and all(
            case in wrong for case in cases if concerned(case)
        )

    return explains


def _near(value: float, wrong: float, rel: float, least: float) -> bool:
    if math.isinf(wrong) or math.isinf(value):
        return value == wrong
    return math.fabs(value - wrong) <= least + rel * math.fabs(wrong)


# -- what the engines are like ----------------------------------------------------------------------------


def _damped(case: Any) -> bool:
    return case.box.damping > 0


def _soft(case: Any) -> bool:
    return case.box.softness > 0


def _hovers(case: Any) -> bool:
    return case.box.margin > 0


def _creeps(case: Any) -> bool:
    return case.box.creep > 0


def _wide_zone(case: Any) -> float:
    return 2 * case.box.radius + case.box.wall_thickness


def _spectral_radius(case: Any, z: float) -> float:
    a, b, _, c, d, _ = case.box.matrix(case.box.omega, z / case.box.omega)
    return float(max(abs(np.linalg.eigvals([[a, b * case.box.omega], [c / case.box.omega, d]]))))


def _determinant(case: Any) -> float:
    h = 0.5 / case.box.omega
    a, b, _, c, d, _ = case.box.matrix(case.box.omega, h)
    return a * d - b * c


def _keeps_area(case: Any) -> bool:
    return bool(case.truth["symplectic"])


def _order_is(order: int) -> Callable[[Any], bool]:
    return lambda case: case.truth["order"] == order


def _finite(key: str) -> Callable[[Any], bool]:
    return lambda case: math.isfinite(case.truth[key])


def _recovers(case: Any) -> bool:
    """Whether stable steps follow the first unstable one, within the range of the search."""
    limit = case.truth["max_stable_step"] * case.box.omega
    if not 0 < limit < 10:
        return False
    return any(_spectral_radius(case, z) <= 1 + 1e-8 for z in np.arange(limit + 0.2, 10, 0.1))


def _at_dt(kept: Callable[[float], float]) -> Callable[[Any, Any], float]:
    return lambda _, case: kept(case.box.matrix(0.0, case.box.dt)[4]) / case.box.dt


def _landing(case: Any) -> float:
    """How deep a body that is put down gets at most."""
    start = [0.0, 0.0, case.box.radius]
    q, _ = case.box.run("floor", start, [0.0] * 3, case.box.dt, round(1 / case.box.dt), [0.0] * 3)
    return max(0.0, case.box.radius - float(q[:, 2].min()))


def _resting(case: Any) -> float:
    """radius - z at rest, negative where the engine keeps a margin."""
    return case.truth["rest_penetration"] or -case.box.margin


# -- what was tried, from the notes of the bench ----------------------------------------------------------


def _one_start(cases: list[Any]) -> bool:
    """Hardly any speed was tried from more than one place."""
    starts: dict[Any, set[Any]] = {}
    for number, case in enumerate(cases):
        for scene, q0, v0, *_ in case.runs:
            if scene == "wall":
                starts.setdefault((number, v0), set()).add(q0)
    return sum(len(places) > 1 for places in starts.values()) <= 0.2 * len(starts)


def _too_high(most: float) -> Callable[[str, list[Any]], bool]:
    """Wrong values are too high, finite, and up to so many times the right ones."""

    def explains(key: str, cases: list[Any]) -> bool:
        wrong = [case for case in cases if not right(key, case)]
        return all(
            _finite(key)(case)
            and math.isfinite(case.measured(key))
            and case.truth[key] < case.measured(key) <= most * case.truth[key]
            for case in wrong
        )

    return explains


def _infinite(key: str, cases: list[Any]) -> bool:
    """Some value is infinite where the right one is not, and every other wrong one is too high."""
    wrong = [case for case in cases if not right(key, case)]
    return any(math.isinf(case.measured(key)) for case in wrong) and all(
        case.measured(key) > case.truth[key] for case in wrong
    )


def _flattered(key: str, cases: list[Any]) -> bool:
    """Wrong values are up to two too high, those of first-order engines that keep area among them, and runs
    were made that start at rest or in the middle, or end after whole half-turns."""
    wrong = [case for case in cases if not right(key, case)]
    special = any(
        scene == "spring" and n > 2 and (not any(q0) or not any(v0) or _half_turns(n * h * case.box.omega))
        for case in cases
        for scene, q0, v0, h, n, _ in case.runs
    )
    return (
        special
        and all(case.truth[key] < case.measured(key) <= case.truth[key] + 2 for case in wrong)
        and all(case in wrong for case in cases if case.truth["order"] == 1 and _keeps_area(case))
    )


def _half_turns(angle: float) -> bool:
    return abs(angle / math.pi - round(angle / math.pi)) < 1e-3


def _share_lost(key: str, cases: list[Any]) -> bool:
    """Damped engines get (1 - exp(-c T)) / T, with T the time of a run of a free body without force."""

    def looks(case: Any) -> bool:
        times = {
            n * h for scene, _, v0, h, n, force in case.runs if scene == "free" and any(v0) and not any(force)
        }
        lost = [(1 - math.exp(-case.truth[key] * t)) / t for t in times if case.truth[key] * t > 0.05]
        return any(_near(case.measured(key), value, 0.005, 0.0) for value in lost)

    damped = [case for case in cases if _damped(case)]
    return bool(damped) and all(right(key, c) for c in cases if c not in damped) and all(map(looks, damped))


def _tiny_steps(key: str, cases: list[Any]) -> bool:
    """On the spring, runs were made whose differences are lost in rounding for a method of fourth order."""
    return any(
        scene == "spring" and n > 2 and h * case.box.omega < 0.005
        for case in cases
        for scene, _, _, h, n, _ in case.runs
    )


def _both(*looks: Callable[[str, list[Any]], bool]) -> Callable[[str, list[Any]], bool]:
    return lambda key, cases: all(look(key, cases) for look in looks)


def _no_zero(key: str, cases: list[Any]) -> bool:
    """Engines that are never stable get a limit, and the others are right or nearly so."""
    never = [case for case in cases if case.truth[key] == 0]
    rest = [case for case in cases if case.truth[key] > 0]
    return any(case.measured(key) > 0 for case in never) and all(
        _near(case.measured(key), case.truth[key], 0.2, 0.0) for case in rest
    )


def _repeats(case: Any) -> list[Any]:
    """The runs that were made more than once."""
    return [run for run in set(case.runs) if case.runs.count(run) > 1]


def _always(value: bool) -> Callable[[str, list[Any]], bool]:
    return lambda key, cases: all(case.measured(key) is value for case in cases)


def _repeated(how: str) -> Callable[[str, list[Any]], bool]:
    """Every engine is called deterministic, and runs were repeated like this."""

    def explains(key: str, cases: list[Any]) -> bool:
        found = [run for case in cases if not case.truth[key] for run in _repeats(case)]
        kind = "never" if not found else "at rest" if not any(map(_moves, found)) else "moving"
        return _always(True)(key, cases) and kind == how

    return explains


def _moves(run: Any) -> bool:
    scene, q0, v0, _, n, force = run
    pulled = (scene == "spring" and any(q0)) or scene == "floor"
    return n > 0 and (any(v0) or any(force) or any(q0) or pulled)


_HYPOTHESES: dict[str, list[tuple[str, Any]]] = {
    "order": [
        ("ORDER_ASSUMED", lambda key, cases: len({case.measured(key) for case in cases}) == 1),
        ("ORDER_LOCAL", _says(lambda t, _: t + 1)),
        ("ORDER_SIGN", _says(lambda t, _: -t)),
        ("ORDER_WITHOUT_LOG", _says(lambda t, _: 2**t, 0.0)),
        ("ORDER_OTHER_LOG", _says(lambda t, _: round(t * math.log(2)), 0.0)),
        ("ORDER_OTHER_LOG", _says(lambda t, _: round(t * math.log10(2)), 0.0)),
        ("ORDER_AGAINST_UNDAMPED", _where(_damped, lambda value, t: -1 <= value < t)),
        ("ORDER_IN_ROUNDING", _both(_where(_order_is(4), lambda value, t: value < t), _tiny_steps)),
        ("ORDER_AT_TURNING_POINT", _flattered),
    ],
    "symplectic": [
        ("SYMPLECTIC_NEVER", _always(False)),
        ("SYMPLECTIC_INVERTED", _says(lambda t, _: not t)),
        ("STABLE_TAKEN_FOR_SYMPLECTIC", _says(lambda _, case: _determinant(case) <= 1 + 1e-6)),
        ("STABLE_TAKEN_FOR_SYMPLECTIC", _says(lambda _, case: _spectral_radius(case, 0.5) <= 1 + 1e-6)),
        ("SYMPLECTIC_STEP_TOO_SMALL", _where(lambda c: not _keeps_area(c) and not _damped(c))),
        (
            "SYMPLECTIC_STEP_TOO_SMALL",
            _where(lambda c: not _keeps_area(c) and not _damped(c) and c.truth["order"] == 4),
        ),
    ],
    "linear_damping": [
        ("DAMPING_ASSUMED", _says(lambda *_: 0.0)),
        ("DAMPING_SIGN", _says(lambda t, _: -t)),
        ("DAMPING_PER_STEP", _says(lambda t, case: t * case.box.dt)),
        ("DAMPING_OF_ENERGY", _says(lambda t, _: 2 * t)),
        ("DAMPING_NOT_LOG", _share_lost),
        ("DAMPING_OF_ENVELOPE", _says(lambda t, _: t / 2)),
        ("DAMPING_AT_DT", _says(_at_dt(lambda kept: -math.log(kept)), 0.002, 0.001)),
        ("DAMPING_AT_DT", _says(_at_dt(lambda kept: 1 - kept), 0.002, 0.001)),
        ("DAMPING_AS_FORCE", _says(lambda t, case: t * case.box.mass)),
    ],
    "max_stable_step": [
        ("LIMIT_ASSUMED", _says(lambda _, case: 2 / case.box.omega)),
        ("RETURNS_Z", _says(lambda t, case: t * case.box.omega)),
        ("TOLERANCE_TOO_TIGHT", _where(_keeps_area, lambda value, t: value < 0.9 * t)),
        ("STABLE_BY_DETERMINANT", _where(_keeps_area, lambda value, t: value > 2 * t)),
        ("LIMIT_FROM_ABOVE", _where(_recovers, lambda value, t: value > t)),
        ("NO_ZERO", _no_zero),
        (
            "NO_INFINITY",
            _where(lambda case: math.isinf(case.truth["max_stable_step"]), lambda value, _: value > 0),
        ),
        (
            "LIMIT_COARSE",
            lambda key, cases: all(
                _near(c.measured(key), c.truth[key], 0.2, 0.06 / c.box.omega) for c in cases
            ),
        ),
    ],
    "friction_anisotropy": [
        ("ANISOTROPY_ASSUMED", _says(lambda *_: 1.0)),
        ("ANISOTROPY_INVERTED", _says(lambda t, _: 1 / t)),
        ("DIAGONAL_COMPONENT", _says(lambda t, _: t / math.sqrt(2))),
        ("CREEP_TAKEN_FOR_SLIP", _where(_creeps)),
        ("NOT_SETTLED", _where(_soft)),
        (
            "NOT_SETTLED",
            _where(lambda case: _soft(case) and not 0.95 < case.truth["friction_anisotropy"] < 1.05),
        ),
    ],
    "rest_penetration": [
        ("PENETRATION_HEIGHT", _says(lambda _, case: case.box.radius - _resting(case))),
        ("PENETRATION_SIGN", _says(lambda _, case: -_resting(case))),
        ("PENETRATION_SIGN", _says(lambda _, case: max(0.0, -_resting(case)))),
        ("PENETRATION_NEGATIVE", _says(lambda _, case: _resting(case))),
        ("PENETRATION_ABSOLUTE", _says(lambda _, case: abs(_resting(case)))),
        # A body that is put down goes at most twice as deep as it comes to rest.
        ("PENETRATION_TOO_EARLY", _where(_soft, lambda value, t: t < value <= 2.1 * t)),
        ("PENETRATION_TOO_EARLY", _says(lambda _, case: _landing(case), 0.05)),
    ],
    "restitution": [
        ("RESTITUTION_SIGN", _says(lambda t, _: -t, 0.0, 0.035)),
        (
            "RESTITUTION_OTHER_SPEED",
            _where(lambda c: c.box.bounce_threshold > 0, lambda value, _: value == 0),
        ),
        ("RESTITUTION_WITH_DRAG", _where(_damped, lambda value, t: value < t)),
        ("RESTITUTION_SQUARED", _says(lambda t, _: t * t, 0.0, 0.04)),
        (
            "RESTITUTION_WITH_DRAG",
            _where(lambda c: _damped(c) or c.box.bounce_threshold > 0, lambda value, t: value < t),
        ),
    ],
    "tunnelling_speed": [
        ("TUNNEL_BY_GEOMETRY", _says(lambda _, case: _wide_zone(case) / case.box.dt)),
        ("TUNNEL_BY_GEOMETRY", _says(lambda _, case: _wide_zone(case) / 2 / case.box.dt)),
        ("TUNNEL_WITHOUT_RADIUS", _says(lambda _, case: case.box.wall_thickness / case.box.dt)),
        (
            "TUNNEL_NO_INFINITY",
            _where(lambda case: math.isinf(case.truth["tunnelling_speed"]), lambda value, _: value > 0),
        ),
        ("TUNNEL_ONE_START", _both(_too_high(math.inf), lambda _, cases: _one_start(cases))),
        ("TUNNEL_FEW_STARTS", _too_high(1.5)),
        ("TUNNEL_NEVER_SEEN", _infinite),
    ],
    "deterministic": [
        ("DETERMINISM_ONE_RUN", _repeated("never")),
        ("DETERMINISM_AT_REST", _repeated("at rest")),
        ("DETERMINISM_TOLERANCE", _repeated("moving")),
        ("DETERMINISM_OTHER_RUN", _always(False)),
        ("DETERMINISM_INVERTED", _says(lambda t, _: not t)),
    ],
}
