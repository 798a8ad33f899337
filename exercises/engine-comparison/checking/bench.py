"""The test bench: hands an engine to ``characterise``, writes down every run, keeps the report.

A report costs a hundred runs or so, and ten checks look at it. So each engine is handed out once per
submission, and what came back, be it a report or a failure, is kept for the checks that follow.
"""

from __future__ import annotations

import copy
import dataclasses
import itertools
import math
import weakref
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from course.scoring import kit

TASK = "characterise"

#: Runs of one engine that are written down, for the diagnosis; a careful report needs some hundred.
MOST_NOTED = 5_000

#: After so many engines on which the time ran out, the rest are not tried: a submission has one minute in
#: all, and its other functions need some of it.
PATIENCE = 3

#: A limit of the spring below it, in units of 1/omega, is the smallest step that is tried, or next to it.
AT_ONCE = 0.06

KEYS = (
    "order",
    "symplectic",
    "linear_damping",
    "max_stable_step",
    "friction_anisotropy",
    "rest_penetration",
    "restitution",
    "tunnelling_speed",
    "deterministic",
)


@dataclass
class Case:
    """One engine and what became of it.

    Attributes:
        name: what findings call it.
        box: the engine itself.
        truth: the right report.
        runs: arguments of every run it was asked for.
        through: speeds of shots from the README's starts that ended behind the wall.
        report: what ``characterise`` returned, once it has.
        failure: why there is no report.
    """

    name: str
    box: Any
    truth: dict[str, Any]
    runs: list[tuple[Any, ...]] = field(default_factory=list)
    through: list[float] = field(default_factory=list)
    report: Any = None
    failure: Exception | None = None

    @property
    def done(self) -> bool:
        """Whether it was handed out already."""
        return self.failure is not None or self.report is not None

    def measured(self, key: str) -> Any:
        """The report's value for a key; None where there is none."""
        return self.report.get(key) if isinstance(self.report, dict) else None


_KEPT: weakref.WeakKeyDictionary[Any, dict[str, list[Case]]] = weakref.WeakKeyDictionary()


def cases(submission: Any, group: str, make: Any) -> list[Case]:
    """The cases of a group, each handed to the submission once.

    Args:
        make: a function that gives the fresh cases of the group.

    Raises:
        StudentFailure: the time of this check is up; what is left is tried in the next one.
    """
    groups = _KEPT.setdefault(submission, {})
    if group not in groups:
        groups[group] = make()
    slow = [case.failure for found in groups.values() for case in found if _timed_out(case)]
    for case in groups[group]:
        if not case.done and len(slow) >= PATIENCE:
            case.failure = slow[0]
        if not case.done:
            _hand_out(submission, case)
    return groups[group]


def _hand_out(submission: Any, case: Case) -> None:
    try:
        report = submission.call(TASK, engine(case))
        if not isinstance(report, dict):
            kit.as_record(report, KEYS, "the report")  # says what came instead
        case.report = report
    except (kit.StudentFailure, kit.CheckFailed) as failure:
        case.failure = failure
        if getattr(failure, "kind", "") in ("timeout", "missing"):
            raise


def _timed_out(case: Case) -> bool:
    return getattr(case.failure, "kind", "") == "timeout"


def reported(found: list[Case], spared: int) -> list[Case]:
    """The cases that have a report, if no more than ``spared`` have none.

    One engine that brings a measurement down is lost to every key, but takes none of them with it.

    Raises:
        StudentFailure, CheckFailed: more have none; the first one's reason.
    """
    failures = [case.failure for case in found if case.failure is not None]
    if len(failures) > spared:
        raise failures[0]
    return [case for case in found if case.failure is None]


class _Handed:
    """An engine as student code gets it. A copy jitters as the original would, and notes runs with it."""

    def __init__(self, case: Case) -> None:
        self._case = case

    def __deepcopy__(self, memo: Any) -> _Handed:
        box = self._case.box
        same = dataclasses.replace(box, noise=copy.deepcopy(box.noise))
        return _Handed(dataclasses.replace(self._case, box=same))

    def info(self) -> dict[str, float]:
        return dict(self._case.box.info())

    def run(self, *args: Any, **kwargs: Any) -> Any:
        case = self._case
        try:
            values = _in_order(args, kwargs)
            answer = case.box.run(*values)
        except (TypeError, ValueError, OverflowError) as error:
            kit.fail(
                "Your code calls the engine with arguments that it does not accept.",
                help="Call engine.run(scene, q0, v0, h, n, force): a scene's name, as many coordinates as it "
                "has in q0, v0 and force, a positive step, a whole number of steps up to 20000.",
                diagnose="ENGINE_MISUSED",
                expected=f"arguments that run accepts: {str(error)[:200]}",
                actual=[*args, *kwargs.values()],
            )
        if len(case.runs) < MOST_NOTED:
            scene, q0, v0, h, n, force = values
            run = (scene, _numbers(q0), _numbers(v0), float(h), int(n), _numbers(force))
            case.runs.append(run)
            if _is_shot(run, case.box.dt) and answer[0][-1][0] > 0:
                case.through.append(run[2][0])
        return answer


def engine(case: Case) -> Any:
    """The engine as student code gets it: two methods and nothing behind them."""
    handed = _Handed(case)
    return kit.black_box(info=handed.info, run=handed.run)


def _is_shot(run: tuple[Any, ...], dt: float) -> bool:
    """Whether a run shoots a body at the wall as the README says."""
    scene, q0, v0, h, _, force = run
    if scene != "wall" or any(force) or not math.isclose(h, dt, rel_tol=1e-6):
        return False
    return -1 - 1.001 * v0[0] * dt <= q0[0] <= -1


def unsafe(case: Case, share: float = 0.97) -> bool:
    """Whether a body was seen to get through at that share of the speed that is reported, or below."""
    value = case.measured("tunnelling_speed")
    number = isinstance(value, int | float | np.number) and math.isfinite(value)
    return number and any(speed <= share * value for speed in case.through)


_NAMES = ("scene", "q0", "v0", "h", "n", "force")


def _in_order(args: tuple[Any, ...], kwargs: dict[str, Any]) -> list[Any]:
    """Arguments by position or by name, as the signature has them."""
    values = dict(zip(_NAMES, args, strict=False))
    if len(args) > len(_NAMES) or set(values) & set(kwargs) or set(values) | set(kwargs) != set(_NAMES):
        raise TypeError("the arguments are scene, q0, v0, h, n and force")
    values |= kwargs
    return [values[name] for name in _NAMES]


def all_noted(case: Case) -> bool:
    """Whether every run is written down, so that one which is not there was not made."""
    return len(case.runs) < MOST_NOTED


def repeated(case: Case) -> int:
    """How a run was made twice in a row, as to compare: 0 not at all, 1 all of it zeros, 2 with numbers that
    jitter would change."""
    pairs = itertools.pairwise(case.runs)
    return max((2 if _shows(run) else 1 for run, again in pairs if run == again), default=0)


def ends_apart(case: Case) -> bool:
    """Whether of the runs of a spring with several steps no two from one start took the same time. They are
    few: a search for the largest stable step makes more."""
    runs = {(q0, v0, h, n) for scene, q0, v0, h, n, _ in case.runs if scene == "spring" and n > 3}
    times = {(q0, v0, float(f"{h * n:.6g}")) for q0, v0, h, n in runs}
    return 1 < len(runs) < 9 and len(times) == len(runs)


def _shows(run: tuple[Any, ...]) -> bool:
    scene, q0, v0, _, n, force = run
    return n > 0 and (scene == "floor" or any(q0) or any(v0) or any(force))


def _numbers(values: Any) -> tuple[float, ...]:
    return tuple(np.asarray(values, dtype=float).ravel().tolist())
