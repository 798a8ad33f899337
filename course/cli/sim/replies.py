"""The replies of ``course sim ... --json``, as types."""

from __future__ import annotations

import msgspec

from course.cli.frame.replies import Envelope, WrittenFile

__all__ = ["Sim", "SimAll", "SimEntry", "SimList", "SimParameter", "SimRow", "SimSetting"]

Value = float | int | str


class SimParameter(msgspec.Struct, frozen=True, kw_only=True):
    """Something ``--set`` can set. ``low`` and ``high`` are None for words, ``choices`` empty for numbers.

    ``above`` is True if the lower end itself is not allowed. ``unit`` is "" for words, "1" for pure numbers.
    """

    name: str
    unit: str
    default: Value
    meaning: str
    low: float | None = None
    high: float | None = None
    above: bool = False
    choices: tuple[str, ...] = ()


class SimEntry(msgspec.Struct, frozen=True, kw_only=True):
    """A simulation in a list: the student answers ``question`` before the run."""

    id: str
    title: str
    question: str
    teaches: str
    parameters: tuple[SimParameter, ...]


class SimList(Envelope, tag="course.sim-list/1", frozen=True, kw_only=True):
    simulations: tuple[SimEntry, ...]


class SimRow(msgspec.Struct, frozen=True, kw_only=True):
    """A measured number; ``theory`` and ``error`` are None where nothing is known in closed form.

    "nan" means that it did not happen; for ``theory``, that it must not.
    """

    quantity: str
    simulated: float
    theory: float | None
    error: float | None
    unit: str
    source: str


class SimSetting(msgspec.Struct, frozen=True):
    """A parameter and its value."""

    value: Value
    unit: str


class Sim(Envelope, tag="course.sim/1", frozen=True, kw_only=True):
    """One run."""

    simulation: str
    title: str
    question: str
    settings: dict[str, SimSetting]
    results: tuple[SimRow, ...]
    finding: str
    plot: WrittenFile | None = None
    csv: WrittenFile | None = None


class SimAll(Envelope, tag="course.sim-all/1", frozen=True, kw_only=True):
    """``run --all``: the introductory simulations in order, and what they show together."""

    results: tuple[Sim, ...]
    concepts: tuple[str, ...]
    insights: tuple[str, ...]
