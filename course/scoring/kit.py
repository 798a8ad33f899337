"""The functions that checks are written with.

Public checks and hidden graders both import this module, and nothing else from the grading side::

    from course.scoring import kit
    from course.physics import systems

Three groups of names come from here. ``as_...`` read what a student's function returned, which may be any
plain value. ``expect_...`` compare and, when they fail, build the finding that the student reads. The rest
is below: callbacks that count, and modules shared by the checks of one exercise.

This side is trusted: nothing here runs in the process that runs the student's code.
"""

from __future__ import annotations

import contextlib
import functools
import math
from collections.abc import Callable, Collection, Hashable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NoReturn, TypeVar, cast

import msgspec
import numpy as np
from numpy.typing import ArrayLike, NDArray

from course.figures.described import Panel, Plot, Series
from course.isolation.failures import IsolationError, StudentFailure
from course.physics.exact import solution
from course.physics.invariants import convergence_order
from course.physics.systems import System
from course.scoring.checks.collected import companion, known_answers, reference, sibling, words
from course.scoring.explain.fingerprint import in_range
from course.scoring.explain.inputs import other_inputs, where_right
from course.scoring.explain.likeness import of_cases
from course.scoring.explain.story import SAME, Diagnosis, Words, said_once
from course.scoring.failures import (
    CLOCK,
    CheckFailed,
    Comparison,
    Report,
    Section,
    broke_at,
    finding_for,
    guarded_section,
)
from course.scoring.values import (
    Inspected,
    as_array,
    as_bool,
    as_integer,
    as_list,
    as_matrix,
    as_number,
    as_pair,
    as_record,
    as_text,
    as_tuple,
    as_vector,
    plain,
)
from course.scoring.verdict import ENTRIES, EVALUATIONS, Divergence, Finding, Tolerance

__all__ = [
    "SAME",
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
    "expect_cases",
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
    "finding_for",
    "first_divergence",
    "guarded_section",
    "in_range",
    "known_answers",
    "march_all_errors",
    "march_errors",
    "reference",
    "sibling",
    "words",
]


# ---
# Expectations: each compares a measured value with theory, and raises ``CheckFailed`` if they differ.
#
# They share these keywords:
#
#     message     what is wrong if it fails, in words without values (a hidden check shows it)
#     help        what to do about it, in words without values
#     input       plain values that reproduce it
#     source      where the tolerance comes from
#     units       unit of the compared values; "1" where there is none
#     diagnose    a ``Diagnosis``, a code, or a function that looks for one; called only on failure
#
# A comparison with NaN always fails: every inequality here is written so that NaN does not pass it.

_Part = TypeVar("_Part", bound=msgspec.Struct | None)
Diagnose = Diagnosis | str | Callable[[], Diagnosis | str | None] | None


def attempt(fn: Callable[[], Any]) -> Any:
    """The value of ``fn()``, or None if the student's code fails in it. For diagnosis code only."""
    try:
        return fn()
    except (StudentFailure, CheckFailed):
        return None


#: What a check does not say; the right answer may be None.
_NOT_SAID: Any = object()
#: The advice of a check that has none of its own, so that every finding has advice.
_ADVICE = "Take one such case, work out by hand what the README asks for, and compare number by number."


def fail(
    message: str,
    *,
    help: str = "",  # noqa: A002 - the field's name in every report
    diagnose: Diagnose = None,
    input: dict[str, Any] | None = None,  # noqa: A002 - the field's name in every report
    expected: Any = _NOT_SAID,
    actual: Any = None,
    quantity: str = "",
    units: str = "",
    tolerance: Tolerance | None = None,
    first_divergence: Divergence | None = None,
    comparison: Comparison | None = None,
) -> NoReturn:
    """End the check with a finding; a diagnosis adds its sentence to the message and replaces the advice.

    ``expected=None`` says that None is right, and is kept as text: a finding's own None is nothing said.
    """
    if expected is None:
        expected = "None"
    clock = CLOCK.get()
    began = clock()
    found, broke = _explained(diagnose)
    search_s = clock() - began
    help = help or _ADVICE  # noqa: A001
    bare = message, help
    guess = found if isinstance(found, Diagnosis) else None
    code: str | None = found if isinstance(found, str) else None
    if guess is not None:
        code = guess.code
        message = said_once(message, guess.looks_like)
        help = guess.advice or help  # noqa: A001
        first_divergence = first_divergence or guess.divergence
    finding = Finding(
        message,
        help,
        code,
        input=None if input is None else plain(input),
        expected=None if expected is _NOT_SAID else plain(expected),
        actual=plain(actual),
        quantity="" if f"`{quantity}`" in message else quantity,
        units=units,
        tolerance=_of_plain(tolerance),
        first_divergence=_of_plain(first_divergence),
    )
    looked = callable(diagnose)
    raise CheckFailed(finding, broke, bare, guess, comparison, looked=looked, search_s=search_s)


def _of_plain(part: _Part) -> _Part:
    """The same with Python's own numbers: a limit that a check works out is one of numpy's."""
    if part is None:
        return part
    return type(part)(**{key: plain(value) for key, value in msgspec.structs.asdict(part).items()})


def _explained(diagnose: Diagnose) -> tuple[Diagnosis | str | None, str]:
    """The diagnosis, and where the search for it raised an exception; the check has failed in any case."""
    if not callable(diagnose):
        return diagnose, ""
    try:
        return attempt(diagnose), ""
    except IsolationError:
        raise
    except Exception as error:  # noqa: BLE001 - a student's value may break any computation; the author is told
        return None, broke_at(error)


def _or_not_finite(number: float, diagnose: Diagnose) -> Diagnose:
    """The diagnosis of a wrong number: the check's own, or else that the number is nan or infinite."""
    if math.isfinite(number):
        return diagnose

    def look() -> Diagnosis | str | None:
        found = attempt(diagnose) if callable(diagnose) else diagnose
        return found or (_NAN if math.isnan(number) else _INFINITE)

    return look


_NAN = Diagnosis(
    "NOT_A_NUMBER",
    'There is a nan in it, which means "not a number".',
    "Where no line says nan, it comes from 0/0, inf - inf, 0 times inf, or the root or logarithm of a "
    "negative number, and spoils whatever is computed from it. Print the intermediate results: where does it "
    "appear first?",
)
_INFINITE = Diagnosis(
    "NOT_FINITE",
    "It is infinite, or was computed from something that is not finite.",
    "Where no line says inf, it comes from a division by zero, from an infinite argument as a factor, or "
    "from something that grows until it overflows. Print the intermediate results: where does it appear "
    "first?",
)


@contextlib.contextmanager
def _read_for(finding: dict[str, Any]) -> Iterator[None]:
    """Reads an answer: if it is of another kind, the finding says for which input."""
    try:
        yield
    except CheckFailed as failed:
        given = failed.finding.input or finding.get("input")
        failed.finding = msgspec.structs.replace(failed.finding, input=given and plain(given))
        raise


def expect_true(condition: Any, message: str, **finding: Any) -> None:
    """``condition`` is True itself; a truthy object is not."""
    if condition is not True and not (isinstance(condition, np.bool_) and bool(condition)):
        fail(message, **finding)


def expect_equal(actual: Any, expected: Any, *, message: str, **finding: Any) -> None:
    """Two plain values (text, whole numbers, True, None, lists of these) of one type are equal."""
    if type(actual) is not type(expected) or actual != expected:
        fail(message, expected=expected, actual=actual, **finding)


def expect_length(value: Any, length: int, *, message: str, name: str = "the result", **finding: Any) -> None:
    """A list or array has this many elements."""
    with _read_for(finding):
        items = as_list(value, name)
    if len(items) != length:
        finding = {"quantity": f"{ENTRIES}{name}", "units": "1"} | finding
        fail(message, expected=length, actual=len(items), **finding)


def expect_close(
    actual: Any,
    expected: float,
    *,
    rel: float = 0.0,
    abs: float = 0.0,  # noqa: A002 - the tolerance's name in every report
    source: str,
    quantity: str,
    message: str,
    units: str = "1",
    **finding: Any,
) -> None:
    """``|actual - expected| <= abs + rel |expected|``; an infinite expectation is met only by itself."""
    with _read_for(finding):
        number = as_number(actual, quantity)
    if math.isinf(expected):
        met = number == expected
    else:
        met = math.fabs(number - expected) <= abs + rel * math.fabs(expected)
    if not met:
        limits = Tolerance(rel=rel or None, abs=abs or None, source=source)
        finding["diagnose"] = _or_not_finite(number, finding.get("diagnose"))
        finding |= {"quantity": quantity, "units": units, "tolerance": limits}
        fail(message, expected=expected, actual=number, **finding)


def expect_cases(
    submission: Any,
    function: str,
    arguments: Sequence[str],
    cases: Iterable[tuple[tuple[Any, ...], Any]],
    *,
    expect: Callable[..., None] = expect_close,
    raised: Mapping[str, str] | None = None,
    **finding: Any,
) -> None:
    """A student's function gives what each case says, to nine digits unless a tolerance is given.

    Args:
        arguments: names of the function's arguments, for the ``input`` that a finding shows; a case may have
            fewer than there are.
        cases: the arguments of a call, and its right result.
        expect: what compares the two; ``finding`` has its keywords.
        raised: by an exception that a mistake raises here, what to do about it.
    """
    if expect is not expect_equal:
        finding = {"rel": 1e-9, "source": _CLOSED_FORM} | finding
    cases = list(cases)
    for i, (args, expected) in enumerate(cases):
        given = dict(zip(arguments, args, strict=False))
        try:
            expect(_called(submission, function, args, raised or {}, given), expected, input=given, **finding)
        except CheckFailed as failed:
            named = [(dict(zip(arguments, one, strict=False)), right) for one, right in cases]
            failed.common = functools.partial(_in_common, submission, function, named, i, expect, finding)
            raise


def _called(
    submission: Any, function: str, args: tuple[Any, ...], raised: Mapping[str, str], given: dict[str, Any]
) -> Any:
    """What a call gives; an exception that has its own advice is a wrong result with that advice."""
    try:
        return submission.call(function, *args)
    except StudentFailure as failure:
        for exception, advice in raised.items():
            if failure.is_a(exception):
                fail(finding_for(failure).message, help=advice, input=given)
        raise


def _in_common(
    submission: Any,
    function: str,
    cases: Sequence[tuple[dict[str, Any], Any]],
    first: int,
    expect: Callable[..., None],
    finding: dict[str, Any],
) -> str:
    """What the first wrong call does to its arguments, or what the wrong results have in common.

    Args:
        cases: the arguments of each call by name, and its right result.
        first: which of them has the first wrong result.
    """
    given = cases[first][0]
    after = submission.call_inspect(function, *given.values()).args_after
    for (name, before), then in zip(given.items(), after, strict=False):
        if isinstance(before, list) and plain(before) != plain(then):
            return f"Your code changes `{name}`, the list that it is given."

    def is_right(args: Iterable[Any], expected: Any) -> bool:
        with contextlib.suppress(CheckFailed):
            expect(_called(submission, function, tuple(args), {"Exception": ""}, {}), expected, **finding)
            return True
        return False

    right: list[tuple[dict[str, Any], Any]] = []
    wrong: list[tuple[dict[str, Any], Any]] = []
    for named, expected in cases:
        (right if is_right(named.values(), expected) else wrong).append((named, expected))
    values = [plain(submission.call(function, *named.values())) for named, _ in wrong]
    said = of_cases([(v, plain(e), plain(named)) for v, (named, e) in zip(values, wrong, strict=True)])
    if said and not said.startswith(("Only ", "Every ")):  # those are of the first case alone
        return said
    if any(plain(e) != plain(wrong[0][1]) for _, e in wrong):  # one value is right by chance
        every = [*wrong, *right]  # most changes are refuted by the first
        for instead, calls in other_inputs([named for named, _ in every]):
            if all(is_right(args, e) for args, (_, e) in zip(calls, every, strict=True)):
                return f"With {instead} every result is right."
    if said or not right:
        return said
    where = where_right([named for named, _ in right], [named for named, _ in wrong])
    return f"For {len(right)} of {len(cases)} inputs it is right{where}."


_CLOSED_FORM = "closed form, written down to twelve digits: only rounding is allowed"


def expect_array(
    actual: Any,
    expected: Any,
    *,
    rel: float = 0.0,
    abs: float = 0.0,  # noqa: A002 - the tolerance's name in every report
    source: str,
    quantity: str,
    message: str,
    units: str = "1",
    t: Any = None,
    **finding: Any,
) -> None:
    """Every element is within ``abs + rel max|expected|``; the shapes are the same.

    Short arrays are shown completely, long ones by the first wrong element.

    Args:
        t: times (s) of the rows, if the array is a trajectory; the finding then says when it went wrong.
    """
    wanted = np.asarray(expected, dtype=float)
    with _read_for(finding):
        array = as_array(actual, wanted.shape, quantity)
    scale = float(np.max(np.abs(wanted), initial=0.0)) if rel else 0.0
    with np.errstate(all="ignore"):
        met = np.abs(array - wanted) <= abs + rel * scale
    if met.all():
        return
    first = tuple(int(i) for i in np.argwhere(~met)[0])
    label = quantity + "".join(f"[{i}]" for i in (first if t is None else first[1:]))
    if t is not None:
        column: Any = (slice(None), *first[1:])
        finding["comparison"] = np.asarray(t, dtype=float), array[column], wanted[column], label, units
        left = Divergence(t=float(t[first[0]]), step=first[0], quantity=label)
        finding.setdefault("first_divergence", left)
    finding["diagnose"] = _or_not_finite(float(array[first]), finding.get("diagnose"))
    finding |= {"units": units, "tolerance": Tolerance(rel=rel or None, abs=abs or None, source=source)}
    if wanted.size <= 6:
        fail(message, expected=wanted, actual=array, **finding)
    at = quantity + "".join(f"[{i}]" for i in first)
    fail(message, expected={at: wanted[first]}, actual={at: array[first]}, **finding)


def expect_order(
    hs: Sequence[float],
    errors: Any,
    order: float,
    *,
    abs: float,  # noqa: A002 - the tolerance's name in every report
    source: str,
    message: str,
    **finding: Any,
) -> None:
    """The errors shrink as the step to the power ``order``: slope of log error over log step.

    Errors that are zero, infinite or NaN have no slope and fail.

    Args:
        hs: steps, s.
        errors: one per step, in any one unit.
        abs: how far the measured slope may be from ``order``.
    """
    values = as_vector(errors, len(hs), "errors")
    measured = convergence_order(hs, values) if np.all((values > 0) & np.isfinite(values)) else math.nan
    if not math.fabs(measured - order) <= abs:
        shown = {f"error at h = {h:.3g} s": float(e) for h, e in zip(hs, values, strict=True)}
        finding["input"] = {**(finding.get("input") or {}), **shown}
        limits = Tolerance(abs=abs, source=source)
        fail(message, expected=order, actual=measured, units="1", tolerance=limits, **finding)


def expect_conserved(
    values: Any, *, rel: float, source: str, quantity: str, message: str, units: str = "1", **finding: Any
) -> None:
    """A quantity stays where it starts: max |x_i - x_0| <= rel |x_0|."""
    array = as_vector(values, None, quantity)
    with np.errstate(all="ignore"):
        change = np.abs(array - array[0])
        off = ~(change <= rel * np.abs(array[0]))
    if off.any():
        worst = float(np.max(np.where(np.isfinite(change), change, math.inf)))
        share = worst / float(np.abs(array[0])) if array[0] else math.inf
        limits = Tolerance(rel=rel, source=source)
        fail(message, expected=0.0, actual=share, units=units, tolerance=limits, **finding)


def expect_bounded(
    actual: Any,
    *,
    low: float = -math.inf,
    high: float = math.inf,
    source: str,
    quantity: str,
    message: str,
    units: str = "1",
    **finding: Any,
) -> None:
    """A number lies in [low, high]."""
    with _read_for(finding):
        number = as_number(actual, quantity)
    if not low <= number <= high:
        limits = Tolerance(source=source)
        finding["diagnose"] = _or_not_finite(number, finding.get("diagnose"))
        expected: Any = [low, high]
        if math.isinf(low) or math.isinf(high):
            expected = {"at most": high} if math.isinf(low) else {"at least": low}
        finding |= {"quantity": quantity, "units": units, "tolerance": limits}
        fail(message, expected=expected, actual=number, **finding)


def expect_evaluations(count: int, allowed: Collection[int], *, message: str, **finding: Any) -> None:
    """The grader's own count of evaluations is one of the allowed numbers."""
    if count not in allowed:
        finding.setdefault("help", "Count the places where your code calls it, and how often a loop does.")
        finding |= {"quantity": EVALUATIONS, "tolerance": Tolerance(abs=0.0, source="counted by the grader")}
        expected = list(allowed) if len(allowed) > 1 else next(iter(allowed))
        fail(message, expected=expected, actual=count, **finding)


def expect_raises(fn: Callable[[], Any], exception: str, *, message: str, **finding: Any) -> None:
    """Calling ``fn`` raises this exception (or one derived from it) in the student's code.

    Any other failure of the student's code is reported unchanged.
    """
    try:
        value = fn()
    except StudentFailure as failure:
        if failure.is_a(exception):
            return
        raise
    fail(message, expected=exception, actual=value, **finding)


def expect_accepts(fn: Callable[[], Any], exception: str, *, message: str, **finding: Any) -> Any:
    """The value of ``fn()``, which must not be refused with this exception; other failures are reported."""
    try:
        return fn()
    except StudentFailure as failure:
        if failure.is_a(exception):
            fail(message, expected="a result", actual=f"{failure.type}: {failure.message}", **finding)
        raise


def expect_untouched(
    before: Sequence[Any],
    inspected: Inspected,
    *,
    names: Sequence[str],
    mutated: Diagnose,
    shared: Diagnose,
    **finding: Any,
) -> None:
    """A call left its arguments as they were, and returned nothing that shares memory with them.

    Args:
        before: the arguments as they were given.
        names: their names; arguments without a name (None) are not compared.
    """
    for name, given, after in zip(names, before, inspected.args_after, strict=True):
        if name and not np.array_equal(given, after):
            message = f"The call changed its argument `{name}` in place."
            fail(message, expected={name: given}, actual={name: after}, diagnose=mutated, **finding)
    if inspected.shared:
        fail("What the call returned is the caller's own array, not a new one.", diagnose=shared, **finding)


# ---
# Callbacks that count, black boxes to experiment with, and a step function run along a known problem.

Array = NDArray[np.float64]


class Counted:
    """A callback that counts its calls; hand it to the student's code and read ``.count`` after.

    The function runs on this side: the student's code sees neither it nor the count. ``fn`` must accept any
    plain arguments; for an acceleration, use ``acceleration`` instead.

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
            if self.refusal is None:
                raise
        if self.refusal is not None:
            raise self.refusal
        return value


counted = Counted


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
            message = "Your code calls accel with something other than a time, a position and a velocity."
            advice = "Call it as accel(t, q, v): a number, then two arrays of the shape your step was given."
            wanted = f"accel(t, q, v) with q and v of shape ({d},)"
            fail(message, help=advice, diagnose="ACCEL_MISUSED", expected=wanted, actual=list(args))
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
    submission: Any, step: str, problem: Problem, counts: Sequence[int]
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
    submission: Any, step: str, problems: Sequence[Problem], counts: Sequence[int]
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
