"""The types of a simulation, its parameters and its results."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from numpy.typing import ArrayLike, NDArray

    Array = NDArray[np.float64]
    Value = float | int | str

__all__ = ["MAX_STEPS", "METHOD", "Column", "Parameter", "Result", "Row", "Simulation", "duration", "step"]

#: A run of more steps than this is refused: it takes too long, and no figure could show it.
MAX_STEPS = 200_000


@dataclass(frozen=True, slots=True)
class Parameter:
    """Something that may be set.

    Attributes:
        name: in ``--set``.
        default: its value if it is not set; the type of the default is the type of the parameter.
        unit: "" for words, "1" for pure numbers.
        low, high: the range, both ends allowed. ``above``: the lower end itself is not.
        choices: the words that are allowed, for a parameter that is a word.
        meaning: one line.
    """

    name: str
    default: Value
    unit: str
    meaning: str
    low: float = -math.inf
    high: float = math.inf
    above: bool = False
    choices: tuple[str, ...] = ()

    @property
    def range(self) -> str:
        """The allowed values in words."""
        if self.choices:
            return " | ".join(self.choices)
        opening = "above " if self.above else ""
        return f"{opening}{self.low:g} to {self.high:g}"


def step(default: float = 0.01, high: float = 1.0) -> Parameter:
    """The time step, as most simulations have it."""
    return Parameter("step", default, "s", "time step h", low=1e-5, high=high)


def duration(default: float, high: float = 1000.0) -> Parameter:
    """How long to simulate."""
    return Parameter(
        "duration", default, "s", "how long to simulate; a whole number of steps", low=1e-5, high=high
    )


#: The method of integration, as the simulations of flight have it.
METHOD = Parameter(
    "method",
    "velocity_verlet",
    "",
    "method of integration",
    choices=("explicit_euler", "semi_implicit_euler", "velocity_verlet", "rk4"),
)


@dataclass(frozen=True, slots=True)
class Row:
    """One number that was measured, beside what theory says.

    Attributes:
        quantity: its meaning, in a few words.
        simulated: measured in the simulation; NaN if it did not happen.
        unit: "1" for a pure number.
        theory: None where nothing is known in closed form, NaN if theory too says that it does not happen.
        source: where the theoretical value comes from.
    """

    quantity: str
    simulated: float
    unit: str
    theory: float | None = None
    source: str = ""

    @property
    def error(self) -> float | None:
        """Simulated less theory, in the unit; None where there is nothing to compare."""
        if self.theory is None or not math.isfinite(self.theory) or math.isnan(self.simulated):
            return None
        return self.simulated - self.theory


@dataclass(frozen=True, eq=False)
class Column:
    """A named series with its unit; shape (n,)."""

    name: str
    unit: str
    values: Array

    @classmethod
    def of(cls, name: str, unit: str, values: ArrayLike) -> Column:
        return cls(name, unit, np.asarray(values, dtype=float))


@dataclass(frozen=True, eq=False)
class Result:
    """The results of one run.

    Attributes:
        simulation: its id.
        settings: every parameter with the value it had.
        rows: measured beside theory.
        headline: the finding in at most 78 characters, for the head of a figure.
        finding: the finding in a sentence or two.
        columns: for ``--csv``: series of one length, the first one being the axis.
    """

    simulation: str
    settings: Mapping[str, Value]
    rows: tuple[Row, ...]
    headline: str
    finding: str
    columns: tuple[Column, ...] = field(repr=False)

    def column(self, name: str) -> Array:
        """The values of one column."""
        return next(column.values for column in self.columns if column.name == name)

    def row(self, quantity: str) -> Row:
        """One row by its quantity."""
        return next(row for row in self.rows if row.quantity == quantity)


@dataclass(frozen=True)
class Simulation:
    """A simulation that can be listed and run.

    Attributes:
        id, title: ...
        question: what to predict before running it.
        teaches: its subject: a kind of simulation, or a factor of its accuracy.
        parameters: those that can be set.
        run: settings (every parameter, checked) -> result.
            It may raise ValueError for settings that are fine alone and impossible together.
    """

    id: str
    title: str
    question: str
    teaches: str
    parameters: tuple[Parameter, ...]
    run: Callable[[Mapping[str, Any]], Result]

    def parameter(self, name: str) -> Parameter | None:
        """A parameter by name."""
        return next((parameter for parameter in self.parameters if parameter.name == name), None)

    def defaults(self) -> dict[str, Value]:
        """Every parameter at its default."""
        return {parameter.name: parameter.default for parameter in self.parameters}
