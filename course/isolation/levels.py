"""Protection levels, a worker's limits, and the interface of every way of starting one.

A canary tries each promise of a level (``course.isolation.probe``); docs/grading.md describes them:

    L3  files, network, processes and other workers are out of reach; what one uses is limited
    L2  the same without namespaces: names and sizes of files can be asked for, two workers can tell each
        other something
    L1  a worker of its own that can be ended, and deadlines; nothing keeps it from what its user may do

A new kind of worker gives a ``Spawner``, its ``Handle`` and a ``Channel``, and is entered in
``spawn.spawner`` under the level whose promise it keeps. It may be less than a process of this system: what
tells the grader from the worker is the wire, not the operating system.
"""

from __future__ import annotations

import socket
import struct
import sys
import time
from dataclasses import dataclass
from enum import StrEnum
from time import monotonic
from typing import Protocol

START_TIMEOUT = 30.0  # s; starting takes about 0.2, a laptop that wakes up may take far longer
#: How often a blocked read or write returns to look at the clock, in s; it ends by the deadline plus this.
TICK_S = 0.1
#: How many bytes of what a worker printed are read; printing itself stops near there.
MAX_OUTPUT = 128 << 10


class Level(StrEnum):
    """How strongly a student's code is isolated; a higher level is not weaker."""

    L1 = "L1"
    L2 = "L2"
    L3 = "L3"


@dataclass(frozen=True)
class Limits:
    """The limits of one worker.

    Attributes:
        memory: bytes of address space.
        file_size: bytes per file, the captured output included.
    """

    cpu_s: int = 210
    memory: int = 2 << 30
    file_size: int = 1 << 20
    descriptors: int = 32


LIMITS = Limits()


@dataclass(frozen=True)
class Exit:
    """How a worker ended. ``signal`` is 0 if it exited by itself."""

    code: int
    signal: int


class Channel(Protocol):
    """The grader's end of a stream of bytes to a worker and back; ``ticking`` makes one of a socket.

    A call that could do nothing for ``TICK_S`` raises BlockingIOError or TimeoutError, so that the caller can
    check the deadline. A worker that is gone shows as no bytes, or as any other OSError.
    """

    def recv(self, most: int, /) -> bytes:
        """Some bytes, at most this many; none once the other end is closed."""

    def recv_into(self, room: memoryview, /) -> int:
        """The same, into existing memory; returns how many."""

    def send(self, data: bytes | bytearray | memoryview, /) -> int:
        """Send some bytes from the beginning; returns how many were sent."""


class Clock(Protocol):
    """The interface that reports how much time a process has used."""

    def cpu_s(self) -> float:
        """Seconds of CPU time so far, from any zero; by the wall clock where the system does not tell."""

    def asleep(self) -> bool:
        """Whether it waits for something other than a processor or a disk, or was stopped."""


class Handle(Clock, Protocol):
    """A running worker.

    At the other end of its channel is ``course.isolation.inside.worker.Worker``, or what speaks as it does:
    READY first, and only once it is locked down as its level promises; then an answer to each request. The
    worker guarantees that nothing of a submission is loaded before READY; everything else it reports is only
    a claim.
    """

    @property
    def channel(self) -> Channel:
        """To the worker and back."""

    def output(self) -> str:
        """Its output so far, at most ``MAX_OUTPUT``; "" after ``finish``, unless it is still there."""

    def look(self) -> None:
        """Ask it where its code is, if it can be asked; the answer comes after ``LOOKS`` of these."""

    def finish(self) -> Exit:
        """Kill it if it is alive, and wait for its end; ``Spawner.tidy`` deletes what it wrote.

        It must end whatever its code does, in a bounded time, and close the channel; safe to call twice.
        """


class Spawner(Protocol):
    """Starts workers, one at a time; each worker has one submission, and its effects end with it.

    Attributes:
        level: what its workers promise; verdicts and gradebooks note it.
    """

    level: Level

    def spawn(self) -> Handle:
        """A new worker, which may import what the spawner was made for and within its limits."""

    def tidy(self) -> None:
        """Delete what ended workers wrote; call it only while no submission's clock runs."""

    def close(self) -> None:
        """End everything that was started; safe to call twice."""


def ticking(sock: socket.socket) -> socket.socket:
    """A socket whose blocking reads and writes return every ``TICK_S``, without a poll before each."""
    if sys.platform == "win32":
        sock.settimeout(TICK_S)
        return sock
    sock.setblocking(True)
    tick = struct.pack("@ll", 0, int(TICK_S * 1e6))
    sock.setsockopt(socket.SOL_SOCKET, socket.SO_RCVTIMEO, tick)
    sock.setsockopt(socket.SOL_SOCKET, socket.SO_SNDTIMEO, tick)
    return sock


# ---
# When a student's code has used up its time. On a busy machine the wall clock says little about the time that
# a function needs: what counts is the CPU time of the worker, and the time for which it was found asleep
# while the grader waited for it. In addition there is a wall limit, for anything that neither of these shows.
# Where the system does not report another process' CPU time (macOS, Windows), only the wall clock counts.


#: The wall limit, as a multiple: a machine may have six times as much to do as it has processors for.
WALL = 6.0
#: Seconds of CPU time for all of one submission; checks after that end as timeouts. By the wall clock there
#: are ``WALL`` times as many.
BUDGET_S = 60.0
#: What searches for the causes of mistakes may ask of a submission beside that.
SEARCH_S = 20.0
_TICK_S = 0.1  # how often a worker that does not answer is looked at


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
        try:  # noqa: SIM105 - hundreds of times for each submission
            self._seen = time.clock_gettime(self._clock)
        except OSError:  # gone: what it had used when it was last asked
            pass
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
