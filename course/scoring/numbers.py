"""Measured and expected values as text for a reader."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from course.scoring.verdict import CheckResult, Tolerance

__all__ = [
    "LARGEST_SEED",
    "format_input",
    "format_pair",
    "format_points",
    "format_tolerance",
    "format_value",
    "numbers_of",
]

#: A gradebook keeps the seed of a run as a whole number of SQLite's.
LARGEST_SEED = 2**63 - 1
_DIGITS = 6
#: A float64 has no more digits than this.
_ALL_DIGITS = 17


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
        return f"{value:.{digits}g}"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(format_value(item, digits) for item in value) + "]"
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key}: {format_value(item, digits)}" for key, item in value.items()) + "}"
    return str(value)


def format_pair(actual: Any, expected: Any) -> tuple[str, str]:
    """Two values with as many digits as it takes to tell them apart."""
    for digits in (_DIGITS, 9, 12, _ALL_DIGITS):
        pair = format_value(actual, digits), format_value(expected, digits)
        if pair[0] != pair[1]:
            break
    return pair


def format_input(values: dict[str, Any]) -> str:
    """The input of a check: "omega = 2, h = 0.05"."""
    return ", ".join(f"{name} = {format_value(value)}" for name, value in values.items())


def format_tolerance(tolerance: Tolerance, units: str) -> str:
    """A tolerance and where it comes from: "within 2 % (closed form)"."""
    parts = []
    if tolerance.rel is not None and math.isfinite(tolerance.rel):
        percent = 100 * tolerance.rel
        parts.append(f"{percent:.3g} %" if percent >= 0.01 else f"{tolerance.rel:.1g} of it")
    if tolerance.abs is not None:
        parts.append(f"{tolerance.abs:.3g}{unit(units)}")
    source = f" ({tolerance.source})" if tolerance.source else ""
    return f"within {' or '.join(parts)}{source}" if parts else tolerance.source


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
            rows.append((label, f"{actual}{_unit_of(check.actual, units)}"))
    if check.expected is not None:
        within = f", {format_tolerance(check.tolerance, units)}" if check.tolerance else ""
        rows.append(("expected", f"{expected}{_unit_of(check.expected, units)}{within}"))
    if check.input:
        rows.append(("input", format_input(check.input)))
    if check.first_divergence:
        place = check.first_divergence
        when = f"step {place.step}, t = {format_value(place.t)} s"
        rows.append(("differs", f"{place.quantity}, first at {when}"))
    if check.diagnosis:
        rows.append(("diagnosis", check.diagnosis))
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
    return f"raised {name}" in check.message and said.rstrip(" .") in check.message
