"""The replies of ``course engines ... --json``, as types."""

from __future__ import annotations

from typing import Any

import msgspec

from course.cli.frame.replies import Envelope, WrittenFile

__all__ = ["Engine", "EngineList", "EngineMachine", "EngineRow", "EngineScenario", "Engines"]


class Engine(msgspec.Struct, frozen=True, kw_only=True):
    """One engine. ``usable`` is "installed and it starts"; ``command`` installs what is missing."""

    id: str
    name: str
    package: str
    version: str | None
    extra: str
    licence: str
    about: str
    usable: bool
    missing: str
    command: str


class EngineScenario(msgspec.Struct, frozen=True, kw_only=True):
    """One scenario; ``truth`` is None where nothing is true or false, "inf" for "any speed"."""

    id: str
    title: str
    question: str
    quantity: str
    unit: str
    truth: float | None
    source: str


class EngineList(Envelope, tag="course.engines-list/1", frozen=True, kw_only=True):
    engines: tuple[Engine, ...]
    scenarios: tuple[EngineScenario, ...]


class EngineMachine(msgspec.Struct, frozen=True, kw_only=True):
    """Where and, for the reference, when it was measured."""

    cpu: str
    system: str
    cores: int
    python: str
    measured: str = ""


class EngineRow(msgspec.Struct, frozen=True, kw_only=True):
    """One engine in one scenario.

    ``setting`` is "default" or "tuned"; ``origin`` "measured", "cached" or "reference" (another machine).
    ``status`` is "ok" or why there is no value: not_installed, unavailable, crash, deadline, diverged,
    not_applicable, failed. ``samples`` are what ``value`` is the mean or median of: one for each phase of the
    step or each start. ``best`` marks what is nearest the truth among those measured on this machine.
    """

    engine: str
    scenario: str
    setting: str
    dt: float
    status: str
    value: float | None
    truth: float | None
    error: float | None
    unit: str
    best: bool
    message: str
    origin: str
    measured: str
    version: str
    options: dict[str, Any]
    why: tuple[str, ...]
    samples: tuple[float, ...]
    repeats: int
    spread: float
    details: dict[str, Any]


class Engines(Envelope, tag="course.engines/1", frozen=True, kw_only=True):
    """One comparison. ``reference`` is None unless rows of it are shown."""

    machine: EngineMachine
    reference: EngineMachine | None
    quick: bool
    engines: tuple[Engine, ...]
    scenarios: tuple[EngineScenario, ...]
    rows: tuple[EngineRow, ...]
    findings: tuple[str, ...]
    plots: tuple[WrittenFile, ...] = ()
    csv: WrittenFile | None = None
