"""The results of a comparison, as data: the same in memory, in the cache and in the shipped reference."""

from __future__ import annotations

from typing import Any, Literal

import msgspec

from course.engines.machine import Machine

__all__ = ["DEFAULT", "OK", "TUNED", "Comparison", "EngineState", "Reference", "Row", "Setting", "Status"]

Setting = Literal["default", "tuned"]
Status = Literal[
    "ok", "not_installed", "unavailable", "crash", "deadline", "diverged", "not_applicable", "failed"
]
DEFAULT: Setting = "default"
TUNED: Setting = "tuned"
OK: Status = "ok"


class Row(msgspec.Struct, frozen=True, kw_only=True):
    """One engine in one scenario.

    Attributes:
        engine, scenario: ids.
        setting: ``default`` is the engine as it comes, ``tuned`` with options set for the scenario.
        dt: step, s.
        status: ``ok``, or why there is no value.
        value: in the scenario's unit; None without one.
        message: the reason, where ``status`` is not ``ok``.
        origin: ``measured`` now, ``cached`` from an earlier run on this machine, or from the ``reference``.
        measured: the day, YYYY-MM-DD.
        version: of the engine's package.
        options, why: the settings, and a reason for each.
        samples: the values of which ``value`` is the mean or the median, one for each phase of the step or
            each start; empty for a single run.
        repeats: how often it was measured; ``spread`` is the largest value less the smallest.
        details: further results.
    """

    engine: str
    scenario: str
    setting: Setting
    dt: float
    status: Status
    value: float | None = None
    message: str = ""
    origin: Literal["measured", "cached", "reference"] = "measured"
    measured: str = ""
    version: str = ""
    options: dict[str, Any] = {}
    why: tuple[str, ...] = ()
    samples: tuple[float, ...] = ()
    repeats: int = 1
    spread: float = 0.0
    details: dict[str, Any] = {}

    @property
    def ok(self) -> bool:
        """True if there is a value."""
        return self.status == OK

    @property
    def lowest(self) -> float:
        """The least of the samples; the value where there are none."""
        return min(self.samples, default=self.value or 0.0)

    @property
    def highest(self) -> float:
        """The largest of the samples; the value where there are none."""
        return max(self.samples, default=self.value or 0.0)


class EngineState(msgspec.Struct, frozen=True, kw_only=True):
    """The state of one engine on this machine."""

    id: str
    name: str
    package: str
    extra: str
    licence: str
    about: str
    version: str | None
    usable: bool
    missing: str = ""
    command: str = ""


class Reference(msgspec.Struct, frozen=True, kw_only=True):
    """A measurement made once, for engines that are not installed."""

    format_version: int
    measured: str
    machine: Machine
    rows: tuple[Row, ...]

    @property
    def label(self) -> str:
        """Where and when, in a line."""
        return f"measured on {self.machine}, {self.measured}"


class Comparison(msgspec.Struct, frozen=True, kw_only=True):
    """The results of one comparison.

    Attributes:
        machine: the one it ran on; ``reference`` is None unless rows of it are among ``rows``.
    """

    machine: Machine
    engines: tuple[EngineState, ...]
    rows: tuple[Row, ...]
    reference: Reference | None = None
    quick: bool = False

    @property
    def ran(self) -> bool:
        """True if at least one engine gave a value on this machine."""
        return any(row.ok and row.origin != "reference" for row in self.rows)
