"""Starts worker processes for one grading session, at the protection level it is told to use.

    L3  bubblewrap around a zygote; a worker forked from it gets namespaces, Landlock and seccomp
    L2  the zygote without bubblewrap: Landlock, seccomp and limits
    L1  one plain process per worker: the wire protocol and deadlines, nothing else

The rest of the program talks to a ``Handle``: a channel, a way to kill, and how it ended. What that must be
is written in ``course.isolation.levels``; ``MAKERS`` is where another kind of worker is entered, and nothing
above this package has to know of it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from course.isolation.forked import ZygoteSpawner
from course.isolation.levels import LIMITS, Exit, Handle, Level, Limits, Spawner
from course.isolation.plain import ProcessSpawner
from course.isolation.view import view_for

if TYPE_CHECKING:
    from collections.abc import Callable

__all__ = ["LIMITS", "MAKERS", "Exit", "Handle", "Level", "Limits", "Spawner", "spawner"]


def _plain(level: Level, imports: tuple[str, ...], limits: Limits) -> Spawner:  # noqa: ARG001 - one of MAKERS
    return ProcessSpawner(view_for(imports), imports, limits)


def _forked(level: Level, imports: tuple[str, ...], limits: Limits) -> Spawner:
    return ZygoteSpawner(level, view_for(imports), imports, limits)


#: A function that makes the spawner of each level, from the level, the packages to import and the limits.
MAKERS: dict[Level, Callable[[Level, tuple[str, ...], Limits], Spawner]] = {
    Level.L1: _plain,
    Level.L2: _forked,
    Level.L3: _forked,
}


def spawner(level: Level, imports: tuple[str, ...], *, limits: Limits = LIMITS) -> Spawner:
    """A spawner for submissions that may import ``imports``.

    Raises:
        IsolationError: this machine cannot provide that level.
    """
    return MAKERS[level](level, imports, limits)
