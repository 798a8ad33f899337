"""Running a student's step function along a known problem and measuring its error."""

from __future__ import annotations

import functools
from collections.abc import Hashable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Protocol, cast

import numpy as np
from numpy.typing import NDArray

from course.physics.exact import solution
from course.physics.systems import System

if TYPE_CHECKING:
    Array = NDArray[np.float64]

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
