"""The results of checks and the scores of submissions: the types behind every report and export.

A finding keeps words and values apart: ``message`` and ``help`` never contain a number that a hidden check
must not reveal, so ``for_student`` only has to drop fields, and no other code has to care.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import StrEnum
from typing import Any

import msgspec


class Divergence(msgspec.Struct, frozen=True):
    """The first place where a trajectory left the reference. ``t`` in s."""

    t: float
    step: int
    quantity: str


class Status(StrEnum):
    """How a check, or a whole submission, ended."""

    PASS = "pass"
    FAIL = "fail"
    ERROR = "error"  # the student's code raised
    TIMEOUT = "timeout"
    MEMORY = "memory"
    CRASH = "crash"
    SKIP = "skip"  # a check it depends on did not pass
    UNGRADABLE = "ungradable"
    GRADER_ERROR = "grader_error"  # our fault, never a student's zero


class Visibility(StrEnum):
    PUBLIC = "public"
    HIDDEN = "hidden"


class Tolerance(msgspec.Struct, frozen=True, omit_defaults=True):
    """How far a value may be off, and where that number comes from."""

    rel: float | None = None
    abs: float | None = None
    source: str = ""


class Finding(msgspec.Struct, frozen=True):
    """The measured and the expected value, the reason, and what to do.

    Attributes:
        message: what is wrong, in words without values.
        help: what to do, in words without values.
        diagnosis: which mistake it looks like, as a stable code; None if none is recognised.
        input, expected, actual: plain values that show it.
        quantity: what the actual value is, in words; "" where its message or its own keys say so.
        units: unit of expected and actual; "1" where there is none.
    """

    message: str
    help: str = ""
    diagnosis: str | None = None
    input: dict[str, Any] | None = None
    expected: Any = None
    actual: Any = None
    quantity: str = ""
    units: str = ""
    tolerance: Tolerance | None = None
    first_divergence: Divergence | None = None


class CheckResult(msgspec.Struct, frozen=True, kw_only=True):
    """One check's outcome; the fields of ``checks[]`` in ``course.check/1``, in that order."""

    id: str
    title: str
    task: str
    status: Status
    visibility: Visibility
    points: float
    max_points: float
    input: dict[str, Any] | None = None
    expected: Any = None
    actual: Any = None
    quantity: str = ""
    units: str = ""
    tolerance: Tolerance | None = None
    first_divergence: Divergence | None = None
    diagnosis: str | None = None
    message: str = ""
    help: str = ""
    traceback: str | None = None
    stdout: str | None = None
    blocked_by: str | None = None
    duration_ms: float = 0.0

    @property
    def unwritten(self) -> bool:
        """It found its function as it was handed out."""
        return self.diagnosis == "NOT_IMPLEMENTED"


class Problem(msgspec.Struct, frozen=True):
    """Why a submission has no verdict: a stable code, a sentence, and the fix."""

    code: str
    message: str
    help: str = ""


class Verdict(msgspec.Struct, frozen=True, kw_only=True):
    """Everything one grading of one submission found.

    Attributes:
        state: "graded", "ungradable" or "grader_error".
        isolation: protection level the student's code ran at: "L3", "L2" or "L1".
        error: why it is ungradable, or what broke in the grader; None when graded.
        warnings: remarks that cost no points.
    """

    exercise: str
    scope: str
    state: str
    score: float
    max_score: float
    passed: bool
    checks: tuple[CheckResult, ...]
    isolation: str
    error: Problem | None = None
    warnings: tuple[str, ...] = ()

    @property
    def all_pass(self) -> bool:
        return self.state == "graded" and all(check.status is Status.PASS for check in self.checks)


def not_graded(exercise: str, most: float, state: str, error: Problem) -> Verdict:
    """The verdict on work that no check judged.

    Args:
        most: points of the exercise.
    """
    return Verdict(
        exercise=exercise, scope="full", state=state, score=0.0, max_score=most, passed=False, checks=(),
        isolation="", error=error,
    )  # fmt: skip


def for_student(result: CheckResult) -> CheckResult:
    """A check's result as its student may see it.

    A public check is shown whole. A hidden one keeps title, message, advice, diagnosis and points; input,
    expected and actual values, tolerance, divergence, traceback, output and time are dropped. If the
    student's code gave no usable value, one of a few fixed sentences replaces its own words: it has received
    the hidden input by then, and any words of its own choice could reveal it. Every export that a student may
    read goes through here.
    """
    if result.visibility is Visibility.PUBLIC:
        return result
    none = ("input", "expected", "actual", "tolerance", "first_divergence", "traceback", "stdout")
    dropped = {"quantity": "", "units": "", "duration_ms": 0.0, **dict.fromkeys(none)}
    return msgspec.structs.replace(_unspoken(result), **dropped)


#: What a student reads about a hidden check without a value, by its status: (diagnosis, message, advice).
NO_VALUE = {
    Status.ERROR: (
        "RAISED",
        "`{}` raises an exception in a check whose details are not shown.",
        "Call it yourself: more than once and, if it takes arguments, with others than the README's example, "
        "small, large and unusual.",
    ),
    Status.TIMEOUT: (
        "TIMEOUT",
        "`{}` had not answered when the time was up, in a check whose details are not shown.",
        "Look for a loop whose condition never becomes false, or one that takes far more steps than asked.",
    ),
    Status.MEMORY: (
        "OUT_OF_MEMORY",
        "`{}` asks for more memory than a check may use, in one whose details are not shown.",
        "Look for a list or array that grows in a loop without end.",
    ),
    Status.CRASH: (
        "CRASHED",
        "The Python process that ran `{}` ended, in a check whose details are not shown.",
        "Look for exit(), os._exit(), or a recursion without an end.",
    ),
}
#: The fifth: the value is of an unknown kind, or does not have the required form.
_OTHER_FORM = frozenset(
    {"NOT_PLAIN_DATA", "WRONG_TYPE", "WRONG_KEYS", "WRONG_SHAPE", "NOT_A_PAIR", "RETURNS_NOTHING"}
)


def _unspoken(result: CheckResult) -> CheckResult:
    """A hidden result in fixed words; the student's code could only choose which of five."""
    if result.diagnosis == "MISSING_FUNCTION":
        return result  # known before the code received any input
    status = result.status
    if result.diagnosis in _OTHER_FORM:
        status, diagnosis = Status.FAIL, "OTHER_FORM"
        message = "What `{}` returns has not the form that was asked for."
        advice = "Compare it with the README, for everything that it may be called with."
    elif status in NO_VALUE:
        diagnosis, message, advice = NO_VALUE[status]
    else:
        return result
    told = {"diagnosis": diagnosis, "message": message.format(result.task), "help": advice}
    return msgspec.structs.replace(result, status=status, **told)


#: Largest verdict as JSON, in bytes: how much one submission may add to a gradebook, a page or a line.
MAX_VERDICT = 192 << 10


def bounded(verdict: Verdict) -> Verdict:
    """The verdict in at most ``MAX_VERDICT`` bytes; the least important parts are dropped first."""
    for field in ("stdout", "traceback", "actual", "input", "expected"):
        if len(msgspec.json.encode(verdict)) <= MAX_VERDICT:
            return verdict
        kept = tuple(msgspec.structs.replace(check, **{field: None}) for check in verdict.checks)
        verdict = msgspec.structs.replace(verdict, checks=kept)
    return verdict


def finite(value: Any) -> Any:
    """``value``, with numbers that JSON cannot represent as "nan", "inf" and "-inf"."""
    if type(value) in _AS_THEY_ARE:  # nearly all of a verdict
        return value
    if isinstance(value, float):
        if math.isfinite(value):
            return value
        return "nan" if math.isnan(value) else ("inf" if value > 0 else "-inf")
    if isinstance(value, dict):
        return {key: item if type(item) in _AS_THEY_ARE else finite(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [finite(item) for item in value]
    return value


_AS_THEY_ARE = frozenset({str, int, bool, type(None)})


# ---
# How the lines of a submission are named in messages to the student.


@dataclass(frozen=True, kw_only=True)
class Places:
    """Lines of a file. A notebook has cells, and its own class for them."""

    module: str = ""

    def phrase(self, line: int) -> str:
        """A line within a sentence: "on line 12 of your file"."""
        return f"on line {line} of your file"

    def heading(self, line: int) -> str:
        """A line at the head of a message: "integrators.py, line 12"."""
        return f"{self.module}, line {line}"

    def trace(self, text: str) -> str:
        """The student's frames, whose lines begin with "integrators.py:12 in "."""
        return text


# ---
# Measured and expected values as text for a reader.


#: How the quantity of what a check counted begins. A fact about it would read as one about the result.
ENTRIES, EVALUATIONS = "entries in ", "evaluations"
#: Beginning of the traceback in a result whose check, or whose probe, raised an exception on a student's
#: value.
OURS = "In the check's own code: "
#: A gradebook keeps the seed of a run as a whole number of SQLite's.
LARGEST_SEED = 2**63 - 1
_DIGITS = 6
#: A float64 has no more digits than this.
_ALL_DIGITS = 17
#: Longer texts, sign and point counted, are no round numbers; closer numbers differ by rounding alone.
_ROUND, _AS_GOOD_AS = 4, 1e-12
#: How many digits are tried, in this order, to tell numbers apart.
_MORE_DIGITS = (_DIGITS, 9, 12, _ALL_DIGITS)


def format_points(points: float) -> str:
    """Points without unnecessary decimals: 31, 2.5."""
    return f"{points:.2f}".rstrip("0").rstrip(".")


def in_points(points: float) -> str:
    """Points with their noun: 1 point, 2.5 points."""
    told = format_points(points)
    return f"{told} point" if told == "1" else f"{told} points"


def format_value(value: Any, digits: int = _DIGITS) -> str:
    """A plain value; numbers with so many significant digits."""
    if isinstance(value, bool) or value is None:
        return str(value)
    if isinstance(value, float):
        return _spelled(value, digits)
    if isinstance(value, list | tuple):
        return "[" + ", ".join(format_value(item, digits) for item in value) + "]"
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key}: {format_value(item, digits)}" for key, item in value.items()) + "}"
    return str(value)


def _spelled(value: float, digits: int) -> str:
    """A number with so many digits; more where these would make a round number of one that is not."""
    text = f"{value:.{digits}g}"
    if digits != _DIGITS or len(text) > _ROUND or not math.isfinite(value):
        return text
    return text if abs(value - float(text)) <= _AS_GOOD_AS * abs(value) else f"{value:.10g}"


def format_pair(actual: Any, expected: Any) -> tuple[str, str]:
    """Two values with as many digits as it takes to tell them apart; 3.0 and 3 as Python writes them."""
    for digits in _MORE_DIGITS:
        pair = format_value(actual, digits), format_value(expected, digits)
        if pair[0] != pair[1]:
            return pair
    return (str(actual), str(expected)) if type(actual) is not type(expected) else pair


def format_input(values: dict[str, Any]) -> str:
    """The input of a check: "omega = 2, h = 0.05"."""
    return ", ".join(f"{name} = {format_value(value, _telling(value))}" for name, value in values.items())


def _telling(value: Any) -> int:
    """The digits that a list of numbers needs: more where different ones would all look alike."""
    numbers = [item for item in value if not isinstance(item, str)] if isinstance(value, list | tuple) else []
    if all(item == numbers[0] for item in numbers):
        return _DIGITS
    return next((n for n in _MORE_DIGITS if len({format_value(item, n) for item in numbers}) > 1), _DIGITS)


#: A tolerance up to this share of a value is for rounding, and tells a student nothing.
_ROUNDING = 1e-6


def format_tolerance(tolerance: Tolerance, units: str) -> str:
    """How far a value may be off: "within 2 %"; "" where only rounding is allowed.

    Where the number comes from is for those who read the check, and is not repeated.
    """
    parts = []
    if tolerance.rel is not None and math.isfinite(tolerance.rel) and tolerance.rel > _ROUNDING:
        percent = 100 * tolerance.rel
        parts.append(f"{percent:.3g} %" if percent >= 0.01 else f"{tolerance.rel:.1g} of it")
    if tolerance.abs is not None and tolerance.abs > _ROUNDING:
        parts.append(f"{tolerance.abs:.3g}{unit(units)}")
    return f"within {' or '.join(parts)}" if parts else ""


def _limits(check: CheckResult) -> str:
    """The limits of a number in words; "" where it is not compared with limits."""
    expected, actual, limits = check.expected, check.actual, check.tolerance
    if isinstance(expected, dict) and len(expected) == 1 and expected.keys() <= {"at least", "at most"}:
        return " ".join(f"{side} {format_value(end)}" for side, end in expected.items())
    if limits is None or limits.rel is not None or limits.abs is not None:
        return ""
    match expected, actual:
        case [int() | float() as low, int() | float() as high], int() | float():
            if low <= high:
                return f"from {format_value(low)} to {format_value(high)}"
            # No number is in between: the limit that this one breaks is what its student can use.
            return f"at least {format_value(low)}" if actual < low else f"at most {format_value(high)}"
    return ""


def unit(units: str) -> str:
    """A unit to follow a number; nothing for a pure number."""
    return f" {units}" if units and units != "1" else ""


def numbers_of(check: CheckResult) -> list[tuple[str, str]]:
    """Label and text of every number that a check has to show, in the order it is read."""
    rows: list[tuple[str, str]] = []
    units = check.units
    actual, expected = format_pair(check.actual, check.expected)
    if check.actual is not None or check.expected is not None:
        # A function that gave no value was not measured; the reason takes its place.
        label = {"fail": "measured", "error": "raised"}.get(check.status, "outcome")
        if not _is_said(check):
            of_what = f" ({check.quantity})" if check.quantity else ""
            rows.append((label, f"{actual}{_unit_of(check.actual, units)}{of_what}"))
    if check.expected is not None:
        allowed = format_tolerance(check.tolerance, units) if check.tolerance else ""
        limits = _limits(check)
        shown = f"{limits}{unit(units)}" if limits else f"{expected}{_unit_of(check.expected, units)}"
        rows.append(("expected", f"{shown}{allowed and ', '}{allowed}"))
    if check.input:
        rows.append(("input", format_input(check.input)))
    if check.first_divergence:
        place = check.first_divergence
        when = f"step {place.step}, t = {format_value(place.t)} s"
        rows.append(("differs", f"{place.quantity}, first at {when}"))
    return rows


def _unit_of(value: Any, units: str) -> str:
    """A unit to follow a value: numbers have one, alone or in a list; None, text and truth have none."""
    measured = isinstance(value, int | float | list | tuple) and not isinstance(value, bool)
    return unit(units) if measured else ""


def _is_said(check: CheckResult) -> bool:
    """Whether the message repeats all that is known of an exception: its class and its own words."""
    if check.status != "error" or not isinstance(check.actual, str):
        return False
    name, _, said = check.actual.partition(": ")
    first = said.partition("\\n")[0].rstrip(" .")  # of several lines the first may do
    repeated = said.rstrip(" .") in check.message or check.message.endswith(f": {first}.")
    return f"raised {name}" in check.message and repeated
