"""Sandboxes that sessions take over from each other, where one process opens many, one after the other.

Starting one costs half a second. Each submission has a worker of its own in it, whichever session asks, and
who takes one over has it prove itself once more.
"""

from __future__ import annotations

import contextlib
from typing import TYPE_CHECKING

from course.isolation.failures import IsolationError
from course.isolation.probe import open_spawner, proves_itself
from course.isolation.spawn import Level

if TYPE_CHECKING:
    from collections.abc import Iterator

    from course.isolation.levels import Handle
    from course.isolation.spawn import Spawner

__all__ = ["kept_sandboxes", "open_sandbox"]

#: Free ones and their processors, by what they were opened for; None where none are kept.
_free: dict[object, list[tuple[Spawner, int | None]]] | None = None


@contextlib.contextmanager
def kept_sandboxes() -> Iterator[None]:
    """Until the end of this, a sandbox that a session closes is kept for the next session of its kind."""
    global _free  # noqa: PLW0603 - of this process, as are the sandboxes
    if _free is not None:
        yield
        return
    _free = {}
    try:
        yield
    finally:
        kept, _free = _free, None
        for those in kept.values():
            for sandbox, _ in those:
                sandbox.close()


def open_sandbox(
    imports: tuple[str, ...],
    *,
    at_least: Level = Level.L1,
    at_most: Level = Level.L3,
    processor: int | None = None,
) -> tuple[Spawner, int | None]:
    """A spawner as ``open_spawner`` gives it, or one that was kept, and the processor of its workers.

    Args:
        processor: where this process is while it opens one; a kept one's workers stay where it was opened.

    Raises:
        IsolationError: no level within the bounds works here; the message gives each cause.
    """
    kind = (imports, at_least, at_most)
    those = [] if _free is None else _free.get(kind, [])
    while those:
        kept, there = those.pop()
        if proves_itself(kept):
            return _Kept(kept, kind, there), there
        kept.close()
    real = open_spawner(imports, at_least=at_least, at_most=at_most)
    return (real if _free is None else _Kept(real, kind, processor)), processor


class _Kept:
    """A sandbox that is kept when its session closes it."""

    def __init__(self, real: Spawner, kind: object, processor: int | None) -> None:
        self.level = real.level
        self._real: Spawner | None = real
        self._kind, self._processor = kind, processor

    def spawn(self) -> Handle:
        if self._real is None:
            raise IsolationError("the sandbox is closed")
        return self._real.spawn()

    def tidy(self) -> None:
        if self._real is not None:
            self._real.tidy()

    def close(self) -> None:
        real, self._real = self._real, None
        if real is None:
            return
        if _free is None:
            real.close()
        else:
            _free.setdefault(self._kind, []).append((real, self._processor))
