"""The settings that can be changed in any running world, and their ranges."""

from __future__ import annotations

import math
from dataclasses import dataclass

from course.errors import UsageError

__all__ = ["SETTINGS", "Setting", "checked", "number"]


@dataclass(frozen=True, slots=True)
class Setting:
    """A number that every world has.

    Attributes:
        low, high: the range, both included.
        notch: how much one key press or one step of a slider changes it; a factor if ``times``.
        times: whether ``notch`` multiplies.
        whole: whether it is a whole number.
    """

    name: str
    unit: str
    meaning: str
    low: float
    high: float
    notch: float
    times: bool = False
    whole: bool = False


SETTINGS: dict[str, Setting] = {
    s.name: s
    for s in (
        Setting("gravity", "m/s²", "size of gravity; its direction is the scene's", 0.0, 100.0, 0.5),
        Setting(
            "restitution",
            "1",
            "of every movable body; fixed ones keep theirs, pairs multiply",
            0.0,
            1.0,
            0.05,
        ),
        Setting(
            "friction", "1", "of every movable body; fixed ones keep theirs, pairs multiply", 0.0, 10.0, 0.05
        ),
        Setting("step", "s", "size of the time step", 1e-5, 0.1, 2.0, times=True),
        Setting(
            "iterations", "1", "of the contact solver in each step", 1, 1000, 2.0, times=True, whole=True
        ),
        Setting("left", "m/s", "rim speed of the left wheel, in scenes with wheels", -5.0, 5.0, 0.1),
        Setting("right", "m/s", "rim speed of the right wheel, in scenes with wheels", -5.0, 5.0, 0.1),
    )
}


def checked(key: str, value: object) -> float:
    """A value for a setting.

    Raises:
        UsageError: there is no such setting, or the value is not a number in its range.
    """
    setting = SETTINGS.get(key)
    if setting is None:
        raise UsageError(
            f"There is no setting called {str(key)[:40]!r}.",
            help=f"Settings: {', '.join(SETTINGS)}.",
            code="bad_parameter",
        )
    amount = number(value, key)
    if not setting.low <= amount <= setting.high or (setting.whole and amount != round(amount)):
        kind = "a whole number" if setting.whole else "a number"
        raise UsageError(
            f"{key} must be {kind} from {setting.low:g} to {setting.high:g}, and {amount:g} is not.",
            help=f"{key}: {setting.meaning}.",
            code="bad_parameter",
        )
    return amount


def number(value: object, what: str) -> float:
    """A finite number.

    Raises:
        UsageError: it is none.
    """
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        raise UsageError(f"{what} must be a finite number, not {str(value)[:40]}.", code="bad_parameter")
    return float(value)
