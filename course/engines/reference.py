"""One measurement that ships with the course, for engines that are not installed; always marked as such."""

import functools
import math
from importlib.resources import files
from typing import Any

import msgspec

from course.engines.results import Comparison, Machine, Reference, Row, Setting
from course.engines.scenarios import DT

FORMAT_VERSION = 1
_RATES = ("steps_per_second", "slowest", "fastest", "pymunk_steps_per_second")


@functools.cache
def load() -> Reference:
    """The reference; without rows where it is missing or from another version of the course."""
    path = files("course").joinpath("engines", "reference.json")
    try:
        return msgspec.json.decode(path.read_bytes(), type=Reference)
    except (OSError, msgspec.DecodeError):
        return Reference(format_version=FORMAT_VERSION, measured="", machine=Machine("", "", 0, ""), rows=())


def row(engine: str, scenario: str, setting: Setting) -> Row:
    for one in load().rows:
        same = (one.engine, one.scenario, one.setting) == (engine, scenario, setting)
        if same and math.isclose(one.dt, DT):
            return one
    raise LookupError(f"The reference has no {engine}, {scenario}, {setting}, {DT}.")


def encoded(comparison: Comparison, measured: str) -> bytes:
    """A comparison as the file that ``load`` reads: values only, and neither repeated words nor failures.

    Speeds of another machine on another day are not comparable, so only the ratio to pymunk is stored.

    Args:
        measured: the day, YYYY-MM-DD.
    """
    rows = tuple(
        msgspec.structs.replace(
            row, origin="reference", why=(), samples=_round(row.samples), details=_rounded(row.details)
        )
        for row in comparison.rows
        if row.ok and row.origin != "reference"
    )
    reference = Reference(
        format_version=FORMAT_VERSION, measured=measured, machine=comparison.machine, rows=rows
    )
    return msgspec.json.format(msgspec.json.encode(reference), indent=1) + b"\n"


def _rounded(details: dict[str, object]) -> dict[str, object]:
    """Details with numbers of nine digits: enough to tell two algorithms apart."""
    return {name: _round(value) for name, value in details.items() if name not in _RATES}


def _round(value: Any) -> Any:
    if isinstance(value, float):
        return float(f"{value:.9g}")
    if isinstance(value, list | tuple):
        return type(value)(_round(item) for item in value)
    return value
