"""``key=value`` pairs become checked settings; an unusable pair is refused with its place and its fix."""

from __future__ import annotations

import math
import re
from fractions import Fraction
from typing import TYPE_CHECKING, Any

from course.errors import UsageError
from course.physics.simulator import step_count
from course.simulations.base import MAX_STEPS

if TYPE_CHECKING:
    from collections.abc import Sequence

    from course.simulations.base import Parameter, Result, Simulation, Value

__all__ = ["describe", "parse", "run"]

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
        return simulation.run(settings)
    except ValueError as error:
        raise UsageError(
            f"{simulation.id}: {error}", help=_known(simulation), code="impossible_settings"
        ) from error


def parse(simulation: Simulation, pairs: Sequence[str]) -> dict[str, Any]:
    """Every parameter with its value, those in ``pairs`` read and checked.

    Raises:
        UsageError: see ``run``.
    """
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
        takes = (
            f"{parameter.name} is in {parameter.unit}"
            if parameter.unit != "1"
            else f"{parameter.name} has no unit"
        )
        raise _refuse(pair, f"{takes}, not in {unit}.")
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
    place = " and ".join(
        f"--set {pair}" for pair in pairs if pair.partition("=")[0].strip() in ("step", "duration")
    )
    place = place or simulation.id
    try:
        n = step_count(length, h)
    except ValueError as error:
        raise UsageError(
            f"{place}: {error}", help="Change one of the two with --set.", code="step_does_not_divide"
        ) from error
    if n > MAX_STEPS:
        raise UsageError(
            f"{place}: that is {n:,} steps; at most {MAX_STEPS:,} are run.",
            help=f"Take a step of {length / MAX_STEPS:.3g} s or more, or a shorter duration.",
            code="too_many_steps",
        )
