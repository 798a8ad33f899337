"""Protection levels, what a worker may use, and what every way of starting one provides."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    import socket

__all__ = ["LIMITS", "MAX_OUTPUT", "START_TIMEOUT", "Exit", "Handle", "Level", "Limits", "Spawner"]

START_TIMEOUT = 30.0  # s; starting takes about 0.2, a laptop that wakes up may take far longer
#: How many bytes of what a worker printed are read; printing itself stops near there.
MAX_OUTPUT = 128 << 10


class Level(StrEnum):
    """How strongly a stranger's code is kept apart; a greater letter is not weaker."""

    L1 = "L1"
    L2 = "L2"
    L3 = "L3"


@dataclass(frozen=True)
class Limits:
    """What one worker may use.

    Attributes:
        cpu_s: seconds of CPU; the deadline ends a check long before.
        memory: bytes of address space.
        file_size: bytes per file, the captured output included.
        descriptors: open files.
    """

    cpu_s: int = 90
    memory: int = 2 << 30
    file_size: int = 1 << 20
    descriptors: int = 32


LIMITS = Limits()


@dataclass(frozen=True)
class Exit:
    """How a worker ended. ``signal`` is 0 if it exited by itself."""

    code: int
    signal: int
    cpu_s: float = 0.0


class Handle(Protocol):
    """A running worker."""

    sock: socket.socket

    def output(self) -> str:
        """What it printed so far."""

    def cpu_s(self) -> float:
        """Seconds of CPU time it has used so far; by the wall clock where the system does not tell."""

    def asleep(self) -> bool:
        """Whether it waits for something else than a processor or a disk, or was stopped."""

    def finish(self) -> Exit:
        """Kill it if it lives, and wait for its end; what it wrote is left for ``Spawner.tidy``."""


class Spawner(Protocol):
    """Starts workers, one at a time."""

    level: Level

    def spawn(self) -> Handle:
        """A new worker.

        Raises:
            IsolationError: it could not be started.
        """

    def tidy(self) -> None:
        """Delete what ended workers wrote: at no time when somebody's clock runs."""

    def close(self) -> None:
        """End everything that was started; safe to call twice."""
