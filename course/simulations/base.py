"""The types of a simulation, its parameters and its results."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from course.errors import UsageError
from course.physics.simulator import step_count
from course.physics.state import Array

Value = float | int | str


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
        if self.theory is None or not math.isfinite(self.theory) or not math.isfinite(self.simulated):
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
        headline: the finding in at most 78 characters, for the head of a figure.
        finding: the finding in a sentence or two.
        columns: for ``--csv``: series of one length, the first one being the axis.
        simulation, settings: which one, and every parameter with the value it had; the function ``run`` below
            puts them in, a ``Simulation.run`` by itself does not.
    """

    rows: tuple[Row, ...]
    headline: str
    finding: str
    columns: tuple[Column, ...] = field(repr=False)
    simulation: str = ""
    settings: Mapping[str, Value] = field(default_factory=dict)

    def column(self, name: str) -> Array:
        return next(column.values for column in self.columns if column.name == name)

    def row(self, quantity: str) -> Row:
        return next(row for row in self.rows if row.quantity == quantity)


@dataclass(frozen=True)
class Simulation:
    """A simulation that can be listed and run.

    Attributes:
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
        return next((parameter for parameter in self.parameters if parameter.name == name), None)

    def defaults(self) -> dict[str, Value]:
        return {parameter.name: parameter.default for parameter in self.parameters}


# ---
# ``key=value`` pairs become checked settings; an unusable pair is refused with its place and its fix.


_NUMBER = re.compile(
    r"\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?(?:\s*/\s*\d+)?|[-+]?(?:nan|inf)\w*)\s*(.*?)\s*", re.I
)


def run(simulation: Simulation, pairs: Sequence[str] = ()) -> Result:
    """Run a simulation with some of its parameters set.

    Args:
        pairs: "key=value"; a value may carry its unit ("step=0.01 s") and be a fraction ("step=1/240").

    Raises:
        UsageError: an unknown key, a value that cannot be used, or values that do not go together.
    """
    settings = parse(simulation, pairs)
    _check_steps(simulation, settings, pairs)
    try:
        # A method beyond its limit overflows; infinity is then the honest answer.
        with np.errstate(over="ignore", invalid="ignore"):
            return replace(simulation.run(settings), simulation=simulation.id, settings=settings)
    except ValueError as error:
        raise UsageError(
            f"{simulation.id}: {error}", help=_known(simulation), code="impossible_settings"
        ) from error


def parse(simulation: Simulation, pairs: Sequence[str]) -> dict[str, Any]:
    """Every parameter with its value, those in ``pairs`` read and checked."""
    settings: dict[str, Any] = simulation.defaults()
    seen: set[str] = set()
    for pair in pairs:
        key, equals, text = (part.strip() for part in pair.partition("="))
        if not equals or not key or not text:
            raise UsageError(
                f"--set {pair}: this is not of the form key=value.",
                help=f"For example --set {simulation.parameters[0].name}={simulation.parameters[0].default}.",
                code="bad_setting",
            )
        parameter = simulation.parameter(key)
        if parameter is None:
            raise UsageError(
                f"--set {pair}: {simulation.id} has no parameter {key!r}.",
                help=_known(simulation),
                code="unknown_setting",
            )
        if key in seen:
            raise UsageError(f"--set {pair}: {key} is set twice.", help="Set it once.", code="bad_setting")
        seen.add(key)
        settings[key] = _value(parameter, pair, text)
    return settings


def describe(parameter: Parameter) -> str:
    """One parameter for a list: "height (m, above 0 to 10000, default 10): where the ball starts"."""
    unit = f"{parameter.unit}, " if parameter.unit not in ("", "1") else ""
    default = parameter.default if isinstance(parameter.default, str) else f"{parameter.default:g}"
    return f"{parameter.name} ({unit}{parameter.range}, default {default}): {parameter.meaning}"


def _known(simulation: Simulation) -> str:
    return f"{simulation.id} knows:\n" + "\n".join(f"  {describe(p)}" for p in simulation.parameters)


def _value(parameter: Parameter, pair: str, text: str) -> Value:
    if parameter.choices:
        if text not in parameter.choices:
            raise _refuse(pair, f"{parameter.name} is one of {', '.join(parameter.choices)}.")
        return text
    number, unit = _number(parameter, pair, text)
    if unit and unit != parameter.unit:
        takes = "has no unit" if parameter.unit == "1" else f"is in {parameter.unit}"
        raise _refuse(pair, f"{parameter.name} {takes}, not in {unit}.")
    if not math.isfinite(number):
        raise _refuse(pair, f"{parameter.name} must be a finite number.")
    low = number <= parameter.low if parameter.above else number < parameter.low
    if low or number > parameter.high:
        suffix = f" {parameter.unit}" if parameter.unit != "1" else ""
        raise _refuse(pair, f"{parameter.name} must lie in the range {parameter.range}{suffix}.")
    if isinstance(parameter.default, int):
        if number != round(number):
            raise _refuse(pair, f"{parameter.name} must be a whole number.")
        return round(number)
    return number


def _number(parameter: Parameter, pair: str, text: str) -> tuple[float, str]:
    match = _NUMBER.fullmatch(text)
    if match is None:
        raise _refuse(pair, f"{text!r} is not a number.")
    digits, unit = match[1].replace(" ", ""), match[2]
    try:
        if "/" not in digits:
            return float(digits), unit
        above, below = digits.split("/")
        return float(Fraction(above) / int(below)), unit
    except (ValueError, ZeroDivisionError, OverflowError):
        raise _refuse(pair, f"{text!r} is not a number that {parameter.name} could be.") from None


def _refuse(pair: str, why: str) -> UsageError:
    return UsageError(f"--set {pair}: {why}", help="Change that value and run again.", code="bad_setting")


def _check_steps(simulation: Simulation, settings: dict[str, Any], pairs: Sequence[str]) -> None:
    """A step must divide the duration, and there must not be too many of them."""
    h, length = settings.get("step"), settings.get("duration")
    if h is None or length is None:
        return
    meant = [pair for pair in pairs if pair.partition("=")[0].strip() in ("step", "duration")]
    place = " and ".join(f"--set {pair}" for pair in meant) or simulation.id
    try:
        n = step_count(length, h)
    except ValueError as error:
        help_ = "Change one of the two with --set."
        raise UsageError(f"{place}: {error}", help=help_, code="step_does_not_divide") from error
    if n > MAX_STEPS:
        raise UsageError(
            f"{place}: that is {n:,} steps; at most {MAX_STEPS:,} are run.",
            help=f"Take a step of {length / MAX_STEPS:.3g} s or more, or a shorter duration.",
            code="too_many_steps",
        )


# ---
# Words that several simulations share.


METHOD_NAMES = {
    "explicit_euler": "explicit Euler",
    "semi_implicit_euler": "semi-implicit Euler",
    "velocity_verlet": "velocity Verlet",
    "rk4": "Runge-Kutta 4",
}


def digits(value: float, count: int = 3) -> str:
    """A number with so many significant digits, zeros at the end included: 0.0890 says more than 0.089."""
    return f"{value:#.{count}g}".removesuffix(".")


def percent(share: float) -> str:
    """A share as a percentage that a person reads: "28 %", "0.084 %"; beyond a thousandfold as a multiple."""
    return f"{100 * share:.3g} %" if abs(share) < 1000 else f"{share:.3g} times as much"


def times(number: int) -> str:
    """How often: "once", "4 times"."""
    return "once" if number == 1 else "twice" if number == 2 else f"{number} times"
