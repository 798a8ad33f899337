"""What checks are written with. Public checks and hidden graders both import this module and nothing else
of the grading side::

    from course.grading import kit
    from course.physics import systems

Three groups of names come from here. ``as_...`` read what a student's function returned, which may be any
plain value. ``expect_...`` compare and, when they fail, build the finding that the student reads. The rest
is below: callbacks that count, and modules shared by the checks of one exercise.

This side is trusted: nothing here runs in the process that holds the student's code.
"""

from __future__ import annotations

import functools
import importlib.util
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from course.figures.described import Panel, Plot, Series
from course.grading.expectations import (
    Diagnose,
    attempt,
    expect_accepts,
    expect_array,
    expect_bounded,
    expect_close,
    expect_conserved,
    expect_equal,
    expect_evaluations,
    expect_length,
    expect_order,
    expect_raises,
    expect_true,
    expect_untouched,
    fail,
)
from course.grading.failures import CheckFailed, Diagnosis, StudentFailure, finding_of
from course.grading.marching import Problem, march_all_errors, march_errors
from course.grading.report import Report, Section, guarded_section
from course.grading.values import (
    Inspected,
    as_array,
    as_bool,
    as_integer,
    as_list,
    as_march,
    as_matrix,
    as_number,
    as_pair,
    as_record,
    as_text,
    as_tuple,
    as_vector,
    plain,
)
from course.grading.verdict import Divergence, Finding, Tolerance
from course.scoring.explain.table import FILE as TABLE
from course.scoring.explain.table import read_table
from course.scoring.explain.words import FILE as WORDS
from course.scoring.explain.words import Words, read_words

if TYPE_CHECKING:
    from collections.abc import Callable
    from types import ModuleType

    from numpy.typing import ArrayLike, NDArray

    Array = NDArray[np.float64]

__all__ = [
    "CheckFailed",
    "Counted",
    "Diagnose",
    "Diagnosis",
    "Divergence",
    "Finding",
    "Inspected",
    "Panel",
    "Plot",
    "Problem",
    "Report",
    "Section",
    "Series",
    "StudentFailure",
    "Tolerance",
    "Words",
    "acceleration",
    "as_array",
    "as_bool",
    "as_integer",
    "as_list",
    "as_march",
    "as_matrix",
    "as_number",
    "as_pair",
    "as_record",
    "as_text",
    "as_tuple",
    "as_vector",
    "attempt",
    "black_box",
    "companion",
    "counted",
    "expect_accepts",
    "expect_array",
    "expect_bounded",
    "expect_close",
    "expect_conserved",
    "expect_equal",
    "expect_evaluations",
    "expect_length",
    "expect_order",
    "expect_raises",
    "expect_true",
    "expect_untouched",
    "fail",
    "finding_of",
    "first_divergence",
    "guarded_section",
    "known_answers",
    "march_all_errors",
    "march_errors",
    "plain",
    "reference",
    "sibling",
    "words",
]


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

        What a callback raises reaches the student's code first, which may swallow it or die of it. Either
        way the refusal says more than what came after.
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

    The function runs on this side: the student's code sees neither it nor the count. ``fn`` must put up
    with any plain arguments; wrap an acceleration in ``acceleration`` instead.
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

    Hand it to ``submission.call`` as an argument. The student's code sees an object with those methods and
    nothing of how they answer.
    """
    return {"$methods": methods}


def first_divergence(
    t: ArrayLike, actual: dict[str, Array], expected: dict[str, Array], allowed: ArrayLike
) -> Divergence | None:
    """Where a trajectory first leaves a reference by more than ``allowed``, or None.

    Args:
        t: times, shape (n,), s.
        actual, expected: arrays of shape (n, d) by the name they have in the finding: "q", "v".
        allowed: deviation that is no surprise, one number or shape (n,).
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


def companion(exercise_id: str, module: str) -> ModuleType:
    """A module that the public and hidden checks of an exercise share: ``exercises/<id>/<module>.py``.

    It is loaded by path from the course in use, once a process.

    Raises:
        FileNotFoundError: the exercise has no such file.
    """
    from course.catalog.locate import content

    return _load(content().exercises / exercise_id / f"{module}.py", f"{exercise_id}_{module}")


def reference(exercise_id: str, module: str) -> ModuleType | None:
    """A module that answers for the student, ``solutions/<id>/<module>.py``; None at home, which has none."""
    from course.catalog.locate import content

    solutions = content().solutions
    return (
        None
        if solutions is None
        else _load(solutions / exercise_id / f"{module}.py", f"{exercise_id}_{module}_right")
    )


def known_answers(exercise_id: str, check: str) -> list[Any]:
    """What a public check with fixed inputs expects where there is no reference, in the order it asks."""
    from course.catalog.locate import content

    return [_known(value) for value in read_table(content().exercises / exercise_id / TABLE).answers[check]]


def _known(value: Any) -> Any:
    """A known answer as it was: "inf" a number, and lists of numbers arrays."""
    if isinstance(value, list):
        items = [_known(item) for item in value]
        return np.array(items) if items and all(isinstance(item, float) for item in items) else items
    return float(value) if isinstance(value, str) else value


def words(exercise_id: str) -> Words:
    """The diagnoses of an exercise by their codes, from its ``diagnoses.toml``."""
    from course.catalog.locate import content

    return read_words(content().exercises / exercise_id / WORDS)


def sibling(file: str, module: str) -> ModuleType:
    """A module beside a file of checks: ``sibling(__file__, "bundles")``.

    Raises:
        FileNotFoundError: there is no such file.
    """
    path = Path(file).resolve()
    return _load(path.with_name(f"{module}.py"), f"{path.parent.name}_{module}")


@functools.cache
def _load(path: Path, label: str) -> ModuleType:
    if not path.is_file():
        raise FileNotFoundError(path)
    # Two courses may be in use in one process (tests do that), so the name tells them apart.
    name = f"course_companion_{label}_{abs(hash(path)):x}".replace("-", "_")
    spec = importlib.util.spec_from_file_location(name, path)
    if spec is None or spec.loader is None:
        raise FileNotFoundError(path)
    loaded = importlib.util.module_from_spec(spec)
    sys.modules[name] = loaded  # dataclasses look their own module up
    spec.loader.exec_module(loaded)
    return loaded
