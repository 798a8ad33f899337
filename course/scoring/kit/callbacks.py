"""Callbacks that count, black boxes to experiment with, and a step function run along a known problem."""

from __future__ import annotations

import functools
from collections.abc import Callable, Hashable, Sequence
from dataclasses import dataclass
from typing import Any, Protocol, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from course.isolation.failures import StudentFailure
from course.physics.exact import solution
from course.physics.systems import System
from course.scoring.failures import CheckFailed
from course.scoring.kit.expectations import fail
from course.scoring.values import as_number, as_vector
from course.scoring.verdict import Divergence

Array = NDArray[np.float64]


class Counted:
    """A callback that remembers how it was called.

    Attributes:
        calls: positional arguments of each call, arrays copied.
        refusal: why it refused a call's arguments, if it did.
    """

    def __init__(self, fn: Callable[..., Any]) -> None:
        self._fn = fn
        self.calls: list[tuple[Any, ...]] = []
        self.refusal: CheckFailed | None = None

    @property
    def count(self) -> int:
        """How often the student's code has called it."""
        return len(self.calls)

    def __call__(self, *args: Any, **kwargs: Any) -> Any:
        self.calls.append(tuple(arg.copy() if isinstance(arg, np.ndarray) else arg for arg in args))
        try:
            return self._fn(*args, **kwargs)
        except CheckFailed as refusal:
            self.refusal = self.refusal or refusal
            raise

    def during(self, call: Callable[[], Any]) -> Any:
        """The value of ``call()``; if this callback refused its arguments meanwhile, that is the finding.

        An exception from a callback reaches the student's code first, which may catch it or end with it. In
        both cases the refusal says more than what comes after it.
        """
        try:
            value = call()
        except StudentFailure:
            if self.refusal is not None:
                raise self.refusal from None
            raise
        if self.refusal is not None:
            raise self.refusal
        return value


def counted(fn: Callable[..., Any]) -> Counted:
    """``fn`` as a callback that counts; hand it to the student's code and read ``.count`` after.

    The function runs on this side: the student's code sees neither it nor the count. ``fn`` must accept any
    plain arguments; for an acceleration, use ``acceleration`` instead.
    """
    return Counted(fn)


def acceleration(fn: Callable[[float, Array, Array], ArrayLike], d: int) -> Counted:
    """``fn(t, q, v)`` as a counted callback that refuses anything but a time and two vectors.

    Args:
        fn: the right-hand side, evaluated on this side.
        d: number of coordinates; q and v must have shape (d,).
    """

    def checked(*args: Any, **kwargs: Any) -> Array:
        try:
            t, q, v = (*args, *(kwargs[name] for name in ("t", "q", "v")[len(args) :]))
            t, q, v = as_number(t, "t"), as_vector(q, d, "q"), as_vector(v, d, "v")
        except (CheckFailed, KeyError, ValueError):
            fail(
                "Your code calls accel with something other than a time, a position and a velocity.",
                help="Call it as accel(t, q, v): a number, then two arrays of the shape your step was given.",
                diagnose="ACCEL_MISUSED",
                expected=f"accel(t, q, v) with q and v of shape ({d},)",
                actual=list(args),
            )
        with np.errstate(all="ignore"):
            return np.asarray(fn(t, q, v), dtype=float)

    return Counted(checked)


def black_box(**methods: Callable[..., Any]) -> dict[str, Any]:
    """An object for the student's code to experiment with: its methods are functions evaluated on this side.

    Pass it to ``call`` of a submission as an argument. The student's code sees an object with these methods,
    but not what is behind them.
    """
    return {"$methods": methods}


def first_divergence(
    t: ArrayLike, actual: dict[str, Array], expected: dict[str, Array], allowed: ArrayLike
) -> Divergence | None:
    """Where a trajectory first leaves a reference by more than ``allowed``, or None.

    Args:
        t: times, shape (n,), s.
        actual, expected: arrays of shape (n, d) by the name they have in the finding: "q", "v".
        allowed: allowed deviation, one number or shape (n,).
    """
    times = np.asarray(t, dtype=float)
    limit = np.broadcast_to(np.asarray(allowed, dtype=float), times.shape)
    first: tuple[int, str] | None = None
    for name, values in actual.items():
        with np.errstate(all="ignore"):
            off = np.argwhere(~(np.abs(values - expected[name]) <= limit[:, None]))
        if off.size and (first is None or off[0][0] < first[0]):
            first = int(off[0][0]), f"{name}[{int(off[0][1])}]"
    return None if first is None else Divergence(t=float(times[first[0]]), step=first[0], quantity=first[1])


#: Instants at which a trajectory is compared with the reference. There are several, because the error of a
#: correct method can pass through zero at one of them: at half a period from rest, semi-implicit Euler shows
#: order 2.
CHECKPOINTS = 4


class Marches(Protocol):
    """The part of a submission that is needed here."""

    def march_each(
        self, step_name: str, marches: Sequence[tuple[Any, Any, Any, float, int, float]]
    ) -> list[tuple[Array, Array, Array]]:
        """Times (n + 1,), positions and velocities (n + 1, d) of n steps of the student's, for each march."""
        ...


@dataclass(frozen=True, slots=True)
class Problem:
    """A system, where it starts, and for how long.

    Attributes:
        name: its name for a reader.
        q0, v0: state at t0, d numbers each.
        rate: its angular frequency, rad/s: velocities are divided by it so that they can be added to
            positions.
        span: how long, s.
        t0: start, s.
    """

    name: str
    system: System
    q0: Sequence[float]
    v0: Sequence[float]
    rate: float
    span: float
    t0: float = 0.0

    @property
    def input(self) -> dict[str, Any]:
        """Plain values that reproduce it, for a finding."""
        start = {"q0": list(self.q0), "v0": list(self.v0), "t0": self.t0, "span": self.span}
        return {"problem": self.name, **self.system.params(), **start}

    def run(self, n: int) -> tuple[System, Sequence[float], Sequence[float], float, int, float]:
        """(system, q0, v0, h, n, t0) of a march over the span in n steps."""
        return self.system, self.q0, self.v0, self.span / n, n, self.t0


def march_errors(
    submission: Marches, step: str, problem: Problem, counts: Sequence[int]
) -> tuple[list[float], Array]:
    """How far a student's step strays from the true motion, for several step sizes.

    Args:
        step: name of the student's function.
        counts: numbers of steps to cover the span in; multiples of ``CHECKPOINTS``.

    Returns:
        Step sizes (s) and, for each, the largest distance in (q, v / rate) over the checkpoints.
    """
    return march_all_errors(submission, step, [problem], counts)[0]


def march_all_errors(
    submission: Marches, step: str, problems: Sequence[Problem], counts: Sequence[int]
) -> list[tuple[list[float], Array]]:
    """``march_errors`` on each of several problems, in one round trip."""
    marches = iter(submission.march_each(step, [problem.run(n) for problem in problems for n in counts]))
    return [_errors(problem, [next(marches) for _ in counts]) for problem in problems]


def _errors(problem: Problem, marches: Sequence[tuple[Array, Array, Array]]) -> tuple[list[float], Array]:
    start = (tuple(map(float, problem.q0)), tuple(map(float, problem.v0)), problem.t0)
    q_true, v_true = _true_motion(cast("Hashable", problem.system), *start, problem.span)
    errors = []
    for _, q, v in marches:
        every = (len(q) - 1) // CHECKPOINTS
        rows = slice(every, None, every)
        with np.errstate(all="ignore"):
            off = np.sum((q[rows] - q_true) ** 2 + ((v[rows] - v_true) / problem.rate) ** 2, axis=1)
            errors.append(float(np.sqrt(np.max(off))))
    return [problem.span / (len(q) - 1) for _, q, _ in marches], np.array(errors)


@functools.lru_cache(maxsize=1024)
def _true_motion(
    system: Hashable, q0: tuple[float, ...], v0: tuple[float, ...], t0: float, span: float
) -> tuple[Array, Array]:
    """Position and velocity at the checkpoints, each (CHECKPOINTS, d).

    A grading run draws the same problems for every submission, and the reference often costs more than a
    student's march, so it is computed once.
    """
    times = t0 + span * np.arange(1, CHECKPOINTS + 1) / CHECKPOINTS
    q, v = solution(cast("System", system), q0, v0, times, t0)
    q.setflags(write=False)
    v.setflags(write=False)
    return q, v
