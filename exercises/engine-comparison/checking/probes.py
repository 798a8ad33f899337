"""What wrong values of a report, and the runs they were made with, have in common.

A probe looks at every engine that has a report, at those whose value is right as well. Which known program
would have reported just these values is looked up in a table (``questions.py``); a probe is for the rest.
"""

from __future__ import annotations

import dataclasses
import math
from typing import TYPE_CHECKING, Any

import numpy as np

from course.scoring import kit

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    Probe = Callable[[str, list[Any]], bool]

bench = kit.companion("engine-comparison", "bench")
probing = kit.companion("engine-comparison", "probing")
contact = kit.companion("engine-comparison", "probes_contact")

named = kit.words("engine-comparison")


def of_key(key: str, cases: list[Any]) -> Any:
    """The diagnosis of the values that were reported under ``key``, or None.

    Args:
        cases: every engine that has a report, with ``case.measured(key)`` a number or a bool.
    """
    with np.errstate(all="ignore"):
        probes = [("REPORT_WITHOUT_RUNS", _not_run), *_PROBES[key]]
        if key in probing.TOLERANCES:
            probes[1:1] = [("VALUE_KEPT", _kept), ("VALUE_ROUNDED", probing.rounded)]
        if key in ("rest_penetration", "friction_anisotropy"):
            probes.insert(1, ("SETTLED_ELSEWHERE", _settled_elsewhere))
        return next((named(code) for code, looks in probes if looks(key, cases)), None)


def _not_run(_: str, cases: list[Any]) -> bool:
    return any(not case.runs for case in cases)


def _settled_elsewhere(key: str, cases: list[Any]) -> bool:
    """On each engine whose value is wrong no body was left alone on the floor, and yet one has sunk there."""
    wrong = [case for case in cases if not probing.right(key, case)]
    return all(bench.all_noted(case) and not _left_alone(case) and _has_sunk(key, case) for case in wrong)


def _left_alone(case: Any) -> bool:
    """Or pressed down: not pushed aside."""
    return any(n > 0 and not any(force[:2]) for _, (*_, n, force) in probing.runs([case], "floor"))


def _has_sunk(key: str, case: Any) -> bool:
    """A depth is reported, or bodies are pushed that do not begin on the floor's top."""
    if key == "rest_penetration":
        return bool(case.measured(key) > 0)
    return any(q0[2] != case.box.radius for _, (_, q0, *_) in probing.runs([case], "floor"))


def _kept(key: str, cases: list[Any]) -> bool:
    """Each wrong value is, to the last digit, that of an earlier engine which shows the same numbers and for
    which it is right. Two engines may both have a 0, or both have no limit."""
    wrong = [n for n, case in enumerate(cases) if not probing.right(key, case)]
    return all(
        any(
            cases[n].measured(key) == other.measured(key) and cases[n].box.info() == other.box.info()
            for other in cases[:n]
            if probing.right(key, other) and 0 < math.fabs(other.measured(key)) < math.inf
        )
        for n in wrong
    )


# -- order ------------------------------------------------------------------------------------------------


def _negative(key: str, cases: list[Any]) -> bool:
    """Wrong values are negative, or zero in part, and no right one is."""
    wrong = [case.measured(key) for case in cases if not probing.right(key, case)]
    return min(wrong) < 0 and max(wrong) <= 0


def _one_for_all(key: str, cases: list[Any]) -> bool:
    return len({case.measured(key) for case in cases}) == 1 < len({case.truth[key] for case in cases})


def _flattered(key: str, cases: list[Any]) -> bool:
    """Wrong values are up to two too high, those of first-order engines that keep area among them, and are
    what runs show that start at rest or in the middle, or end after whole half-turns."""
    wrong = [case for case in cases if not probing.right(key, case)]
    return (
        all(case.truth[key] < case.measured(key) <= case.truth[key] + 2 for case in wrong)
        and all(case in wrong for case in cases if case.truth["order"] == 1 and probing.keeps_area(case))
        and all(case.measured(key) in map(round, _slopes(case, ordinary=False)) for case in wrong)
    )


def _refined(case: Any) -> Iterator[tuple[tuple[Any, ...], float, list[int]]]:
    """(start, time, the last three numbers of steps) of spring runs over one time in more and more steps."""
    counts: dict[Any, set[int]] = {}
    for _, (_, q0, v0, h, n, _) in probing.runs([case], "spring"):
        counts.setdefault((q0, v0, float(f"{h * n:.9g}")), set()).add(n)
    for (q0, v0, time), ns in counts.items():
        if len(ns) > 2:
            yield (q0, v0), time, sorted(ns)[-3:]


def _ends(case: Any, start: tuple[Any, ...], time: float, ns: list[int]) -> Any:
    """The ends of these runs on (q, v/omega), without jitter; shape (3, 2)."""
    quiet = dataclasses.replace(case.box, jitter=0.0)
    ends = (quiet.run("spring", *start, time / n, n, [0.0]) for n in ns)
    return np.array([[q[-1][0], v[-1][0] / case.box.omega] for q, v in ends])


#: The whole state (q, v/omega), and that and its parts.
_WHOLE = (slice(None),)
_PARTS = (slice(None), slice(1), slice(1, None))


def _slopes(case: Any, parts: tuple[slice, ...] = _PARTS, *, ordinary: bool) -> set[float]:
    """The slopes of these parts that runs show: ordinary runs, or those which
    start at rest or in the middle, or end after whole half-turns."""
    found = set()
    for (q0, v0), time, ns in _refined(case):
        if (any(q0) and any(v0) and not _half_turns(time * case.box.omega)) != ordinary:
            continue
        coarse, fine = np.diff(_ends(case, (q0, v0), time, ns), axis=0)
        for part in parts:
            slope = np.log2(np.linalg.norm(coarse[part]) / np.linalg.norm(fine[part]))
            if np.isfinite(slope):
                found.add(float(slope))
    return found


def _cut(key: str, cases: list[Any]) -> bool:
    """Each order, right or wrong, is the slope of ordinary runs of the whole state without its decimals."""
    return all(case.measured(key) in map(math.floor, _slopes(case, _WHOLE, ordinary=True)) for case in cases)


def _half_turns(angle: float) -> bool:
    return abs(angle / math.pi - round(angle / math.pi)) < 1e-3


def _lost_in_rounding(key: str, cases: list[Any]) -> bool:
    """Wrong orders are of engines whose finer runs differ by hardly more than rounding."""
    wrong = [case for case in cases if not probing.right(key, case)]
    return all(
        any(
            np.linalg.norm(np.diff(_ends(case, *runs), axis=0)[1]) < max(1e-12, 10 * case.box.jitter)
            for runs in _refined(case)
        )
        for case in wrong
    )


# -- symplectic -------------------------------------------------------------------------------------------


def _tiny_single_step(key: str, cases: list[Any]) -> bool:
    """Engines that lose area pass: single steps of theirs were so small that the loss hides in the threshold,
    and none was h omega = 0.5."""
    wrong = [case for case in cases if not probing.right(key, case)]
    return all(
        case.measured(key)
        and any(z < 0.04 and abs(probing.determinant(case, z) - 1) < 1e-5 for z in _single_steps(case))
        for case in wrong
    ) and not any(math.isclose(z, 0.5, rel_tol=1e-6) for case in cases for z in _single_steps(case))


def _single_steps(case: Any) -> list[float]:
    """h omega of the runs of the spring with a single step."""
    return [h * case.box.omega for _, (_, _, _, h, n, _) in probing.runs([case], "spring") if n == 1]


def _some_refused(key: str, cases: list[Any]) -> bool:
    """Every wrong answer is a No to an engine that keeps area, and others of them got their Yes."""
    kept = [case for case in cases if probing.keeps_area(case)]
    return any(case.measured(key) for case in kept) and all(
        case in kept for case in cases if not probing.right(key, case)
    )


def _took_one_half(case: Any) -> bool:
    return any(math.isclose(z, 0.5, rel_tol=1e-6) for z in _single_steps(case))


def _nearly_kept(key: str, cases: list[Any]) -> bool:
    """Every wrong answer is a Yes to an engine that changes the area by less than a tenth in its step of
    h omega = 0.5, which was taken, and another engine got its No."""
    wrong = [case for case in cases if not probing.right(key, case)]
    changes = {id(case): abs(probing.determinant(case) - 1) for case in cases}
    return all(
        case.measured(key) and changes[id(case)] < 0.1 and _took_one_half(case) for case in wrong
    ) and any(changes[id(case)] > 1e-6 for case in cases if not case.measured(key))


def _passes(which: Callable[[Any], bool]) -> Probe:
    return lambda key, cases: all(case.measured(key) == which(case) for case in cases)


# -- damping ----------------------------------------------------------------------------------------------


def _by_own_time(wrong: Callable[[float, float, int], float], rel: float = 0.005) -> Probe:
    """Damped engines get what ``wrong(rate, h, n)`` makes of a run of a free body, others are right.

    Args:
        rel: how near that is; nothing is said where it is nearly the right value, too.
    """

    def looks(key: str, case: Any) -> bool:
        times = {
            (h, n)
            for _, (_, _, v0, h, n, force) in probing.runs([case], "free")
            if any(v0) and not any(force)
        }
        values = [wrong(case.truth[key], h, n) for h, n in times]
        return any(
            probing.near(case.measured(key), x, rel)
            for x in values
            if not probing.near(case.truth[key], x, 4 * rel)
        )

    def probe(key: str, cases: list[Any]) -> bool:
        damped = [case for case in cases if probing.damped(case)]
        others = (case for case in cases if case not in damped)
        return (
            bool(damped) and all(probing.right(key, c) for c in others) and all(looks(key, c) for c in damped)
        )

    return probe


def _never_free(_: str, cases: list[Any]) -> bool:
    """No run was made in the scene "free"."""
    return (
        any(case.runs for case in cases)
        and all(map(bench.all_noted, cases))
        and not any(True for _ in probing.runs(cases, "free"))
    )


def _long_steps(key: str, cases: list[Any]) -> bool:
    """Every free run had steps of a tenth of dt or more, and wrong rates are what such steps show."""
    free = [(c, h) for c, (_, _, v0, h, _, _) in probing.runs(cases, "free") if any(v0)]

    def looks(case: Any) -> bool:
        steps = {h: case.box.matrix(0.0, h)[4] for c, h in free if c is case}
        shown = [of(keep) / h for h, keep in steps.items() for of in _RATES if keep > 0]
        return any(probing.near(case.measured(key), rate, 1e-3) for rate in shown)

    return min((h / case.box.dt for case, h in free), default=0.0) > 0.09 and all(
        looks(case) for case in cases if not probing.right(key, case)
    )


#: The rate that a step shows, times the step, from what it leaves of the speed.
_RATES = (lambda keep: -math.log(keep), lambda keep: 1 - keep, lambda keep: 1 / keep - 1)


def _where_damped(looks: Callable[[float, float], bool]) -> Probe:
    """The values of damped engines look so, whatever the others are."""

    def probe(key: str, cases: list[Any]) -> bool:
        damped = [case for case in cases if probing.damped(case)]
        return bool(damped) and all(looks(case.measured(key), case.truth[key]) for case in damped)

    return probe


# -- the largest stable step ------------------------------------------------------------------------------


def _beyond_the_first(key: str, cases: list[Any]) -> bool:
    """Wrong limits are of engines that are stable again beyond the first unstable range, and lie in the
    second half of that range or beyond it."""
    wrong = [case for case in cases if not probing.right(key, case)]
    return all(
        probing.recovers(case) and case.truth[key] + 0.5 / case.box.omega < case.measured(key) < math.inf
        for case in wrong
    )


def _no_zero(key: str, cases: list[Any]) -> bool:
    """Engines that are never stable get a limit, and the others are right or nearly so."""
    never = [case for case in cases if case.truth[key] == 0]
    rest = [case for case in cases if case.truth[key] > 0]
    return any(case.measured(key) > 0 for case in never) and all(
        probing.right(key, case) or probing.near(case.measured(key), case.truth[key], 0.2) for case in rest
    )


def _at_once(key: str, cases: list[Any]) -> bool:
    """Every wrong limit is too low, and one is the smallest step or next to it."""
    wrong = [case for case in cases if not probing.right(key, case)]
    return all(case.measured(key) < case.truth[key] for case in wrong) and any(
        case.measured(key) * case.box.omega < bench.AT_ONCE for case in wrong
    )


def _coarse(key: str, cases: list[Any]) -> bool:
    """All are close: within a fifth, or a step of the search."""
    return all(
        probing.right(key, c)
        or (
            0 < c.truth[key] < math.inf
            and math.fabs(c.measured(key) - c.truth[key]) <= max(0.2 * c.truth[key], 0.06 / c.box.omega)
        )
        for c in cases
    )


# -- repeating --------------------------------------------------------------------------------------------


def _repeated(how: int) -> Probe:
    """Every engine is called deterministic, and runs were made twice in a row like this."""
    return lambda key, cases: (
        probing.always(True)(key, cases)
        and max(map(bench.repeated, cases)) == how
        and (how == 2 or all(map(bench.all_noted, cases)))
    )


_PROBES: dict[str, list[tuple[str, Probe]]] = {
    "order": [
        ("ORDER_TIME_NOT_FIXED", lambda _, cases: all(map(bench.ends_apart, cases))),
        ("ORDER_ASSUMED", _one_for_all),
        ("ORDER_AGAINST_UNDAMPED", probing.where(probing.damped, lambda value, t: -1 <= value < t)),
        (
            "ORDER_IN_ROUNDING",
            probing.both(
                probing.where(lambda case: case.truth["order"] == 4, lambda value, t: value < t),
                _lost_in_rounding,
            ),
        ),
        ("ORDER_AT_TURNING_POINT", _flattered),
        ("ORDER_ROUNDED_DOWN", _cut),
    ],
    "symplectic": [
        ("SYMPLECTIC_NEVER", probing.always(False)),
        ("STABLE_TAKEN_FOR_SYMPLECTIC", _passes(lambda case: probing.determinant(case) <= 1 + 1e-6)),
        ("STABLE_TAKEN_FOR_SYMPLECTIC", _passes(lambda case: probing.spectral_radius(case, 0.5) <= 1 + 1e-6)),
        ("SYMPLECTIC_STEP_TOO_SMALL", _tiny_single_step),
        ("SYMPLECTIC_SOME_REFUSED", _some_refused),
        ("SYMPLECTIC_TOLERANCE", _nearly_kept),
    ],
    "linear_damping": [
        ("DAMPING_ASSUMED", lambda key, cases: all(case.measured(key) == 0 for case in cases)),
        ("DAMPING_OTHER_SCENE", _never_free),
        ("DAMPING_NOT_LOG", _by_own_time(lambda c, h, n: (1 - math.exp(-c * n * h)) / (n * h))),
        ("DAMPING_NOT_LOG", _by_own_time(lambda c, h, n: (1 - math.exp(-c * n * h)) / (n * h), 0.0005)),
        ("DAMPING_NOT_LOG", _by_own_time(lambda c, h, n: 1 - math.exp(-c * n * h))),
        ("DAMPING_PER_STEP", _by_own_time(lambda c, h, n: c * h)),
        ("DAMPING_PER_STEP", _by_own_time(lambda c, h, n: c * h * n)),
        ("DAMPING_TIME_CONSTANT", _where_damped(lambda value, c: probing.near(value, 1 / c, 0.01))),
        ("DAMPING_OVER_ONE_STEP", _by_own_time(lambda c, h, n: c * n)),
        ("DAMPING_ROWS_COUNTED", _by_own_time(lambda c, h, n: c * n / (n + 1), 0.0005)),
        ("DAMPING_AT_DT", _long_steps),
        ("DAMPING_SIGN", _negative),
    ],
    "max_stable_step": [
        ("TOLERANCE_TOO_TIGHT", probing.where(probing.keeps_area, lambda value, t: value < 0.9 * t)),
        ("LIMIT_FROM_ABOVE", _beyond_the_first),
        ("LIMIT_NEVER_SEEN", probing.infinite),
        ("NO_ZERO", _no_zero),
        ("NO_INFINITY", probing.where(probing.endless("max_stable_step"), lambda value, _: value > 0)),
        ("LIMIT_AT_ONCE", _at_once),
        ("LIMIT_COARSE", _coarse),
        ("LIMIT_NEVER_SEEN", probing.some_infinite),
    ],
    **contact.PROBES,
    "restitution": [("RESTITUTION_SIGN", _negative), *contact.PROBES["restitution"]],
    "deterministic": [
        ("DETERMINISM_ONE_RUN", _repeated(0)),
        ("DETERMINISM_AT_REST", _repeated(1)),
        ("DETERMINISM_NOT_COMPARED", _repeated(2)),
        ("DETERMINISM_OTHER_RUN", probing.always(False)),
    ],
}
