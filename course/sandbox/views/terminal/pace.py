"""How much of a frame goes into stepping: keys and picture stay quick, however slow the physics is."""

from __future__ import annotations

import math
from time import perf_counter
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable

    from course.sandbox.world.world import World

__all__ = ["Pacer", "speed_in_words"]

#: Steps between looks at the clock.
_CHUNK = 16
#: The longest lag behind real time that is caught up, in s.
_GAP = 0.1


class Pacer:
    """Lets a world follow real time as far as it can.

    Args:
        budget: of real time for the steps of one frame, in s.
        clock: real time, in s.

    Attributes:
        pace: the share of the requested steps that was made lately, 0 to 1.
    """

    def __init__(self, world: World, budget: float, clock: Callable[[], float] = perf_counter) -> None:
        self.pace = 1.0
        self._world, self._budget, self._clock = world, budget, clock

    def advance(self, dt: float, until: float | None = None) -> None:
        """Step for this long, but no longer than a frame has time for.

        Args:
            dt: real time since the last frame, in s.
            until: simulated time at which to stop, in s.
        """
        world = self._world
        dt = min(dt, _GAP)
        if world.paused or dt <= 0.0:
            return
        if until is not None:
            dt = min(dt, max(0.0, until - world.t) / world.speed)
        parts = max(1, math.ceil(dt * world.speed / world.settings["step"] / _CHUNK))
        began, made = self._clock(), parts
        for number in range(1, parts + 1):
            world.advance(dt / parts)
            if self._clock() - began > self._budget:
                made = number
                break
        self.pace += 0.1 * (made / parts - self.pace)


def speed_in_words(speed: float) -> str:
    """How fast time passes: "real time", "2 x real time", "1/8 of real time"."""
    if abs(speed - 1.0) < 1e-9:
        return "real time"
    if speed > 1.0:
        return f"{speed:.3g} x real time"
    return f"1/{1 / speed:.0f} of real time"
