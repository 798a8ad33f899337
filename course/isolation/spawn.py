"""Starts worker processes for one grading session, at the protection level it is told to use.

    L3  bubblewrap around a zygote; a worker forked from it gets namespaces, Landlock and seccomp
    L2  the zygote without bubblewrap: Landlock, seccomp and limits
    L1  one plain process per worker: the wire protocol and deadlines, nothing else

The rest of the program talks to a ``Handle``: a socket, a way to kill, and how it ended.
"""

from __future__ import annotations

from course.isolation.forked import ZygoteSpawner
from course.isolation.levels import LIMITS, Exit, Handle, Level, Limits, Spawner
from course.isolation.plain import ProcessSpawner
from course.isolation.view import view_for

__all__ = ["LIMITS", "Exit", "Handle", "Level", "Limits", "Spawner", "spawner"]


def spawner(level: Level, imports: tuple[str, ...], *, limits: Limits = LIMITS) -> Spawner:
    """A spawner for submissions that may import ``imports``.

    Raises:
        IsolationError: this machine cannot provide that level.
    """
    view = view_for(imports)
    if level is Level.L1:
        return ProcessSpawner(view, imports, limits)
    return ZygoteSpawner(level, view, imports, limits)
