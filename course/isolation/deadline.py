"""When a student's code has used up its time, measured as the CPU time of its worker.

On a busy machine the wall clock says little about the time that a function needs. What counts is the CPU time
of the worker, and the time for which it was found asleep while the grader waited for it. In addition there is
a wall limit several times as long, for anything that neither of these shows. Where the system does not report
the CPU time of another process (macOS, Windows), only the wall clock counts.
"""

from __future__ import annotations

import contextlib
import sys
import time
from time import monotonic
from typing import Protocol

#: The wall limit, as a multiple: a machine may have six times as much to do as it has processors for.
WALL = 6.0
_TICK_S = 0.1  # how often a worker that does not answer is looked at


class Clock(Protocol):
    """The interface that reports how much time a process has used."""

    def cpu_s(self) -> float:
        """Seconds so far, from any zero."""

    def asleep(self) -> bool:
        """Whether it waits for something other than a processor or a disk, or was stopped."""


class ProcessClock:
    """The CPU time of another process of this machine, all its threads together.

    Args:
        pid: as seen from here; it must not have been waited for.
    """

    def __init__(self, pid: int) -> None:
        self._clock = (~pid << 3) | 2  # CPUCLOCK_SCHED of a process; clock_getcpuclockid(3)
        self._stat = f"/proc/{pid}/stat"
        self._seen = 0.0

    def cpu_s(self) -> float:
        if sys.platform != "linux":
            return monotonic()
        with contextlib.suppress(OSError):  # gone: what it had used when it was last asked
            self._seen = time.clock_gettime(self._clock)
        return self._seen

    def asleep(self) -> bool:
        if sys.platform != "linux":
            return False
        try:
            with open(self._stat, "rb") as handle:  # noqa: PTH123 - ten times a second
                return handle.read().rpartition(b") ")[2][:1] in b"STt"
        except OSError:
            return False


class Deadline:
    """The time limit of one piece of work; its clock does not run until a worker is watched.

    Args:
        seconds: of CPU time and of sleep.
        wall: seconds by the wall clock; ``WALL`` times as many if None.

    Attributes:
        earliest: ``time.monotonic()`` before which it cannot have passed, so nothing need be checked until
            then.
    """

    def __init__(self, seconds: float, wall: float | None = None) -> None:
        self._began = monotonic()
        self._seconds = seconds
        self._wall = WALL * seconds if wall is None else wall
        self._clock: Clock | None = None
        self._from = 0.0  # of the clock, when it was last settled
        self._settled = 0.0
        self._looked = self._began
        self._cpu_then = 0.0
        self.earliest = 0.0

    def watch(self, clock: Clock | None) -> None:
        """Count this process's time from now on; None only adds up what the previous one has used."""
        if self._clock is not None:
            self._settled = self.used
        self._clock = clock
        if clock is not None:
            self._from = clock.cpu_s()
        self.waiting()

    def end(self) -> None:
        """End the time from any thread."""
        self._wall, self.earliest = -1.0, 0.0

    def postpone(self, seconds: float) -> None:
        """Allow this much more by the wall clock, because the grader spent it."""
        self._wall += seconds

    @property
    def used(self) -> float:
        """Seconds of CPU time and of sleep so far."""
        running = self._clock.cpu_s() - self._from if self._clock is not None else 0.0
        return self._settled + running

    @property
    def wall(self) -> float:
        """Seconds by the wall clock so far."""
        return monotonic() - self._began

    def waiting(self) -> None:
        """From now on the grader waits for the worker, so time that the worker sleeps counts."""
        self._looked = monotonic()
        self._cpu_then = self._clock.cpu_s() if self._clock is not None else 0.0

    def passed(self) -> bool:
        """Whether the time is up; asked again and again while nothing arrives."""
        now = monotonic()
        if now - self._looked >= _TICK_S and self._clock is not None:
            cpu = self._clock.cpu_s()
            if self._clock.asleep():
                # No more than was observed: on a busy machine the last look may be long ago.
                self._settled += max(0.0, min(now - self._looked, 2 * _TICK_S) - (cpu - self._cpu_then))
            self._looked, self._cpu_then = now, cpu
        used = self.used
        # A process cannot use more than a second per second, so it need not be checked before.
        self.earliest = min(now + self._seconds - used, self._began + self._wall)
        return used > self._seconds or now - self._began > self._wall
