"""Finds the protection level of this machine by trying it, never by checking versions.

A level counts if a canary, run as a submission, can neither read a file it must not see, nor open a socket,
nor start a process. The grader gets a spawner that has just passed this test.
"""

from __future__ import annotations

import contextlib
import os
import shutil
import sys
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from course.isolation.failures import IsolationError, StudentFailure
from course.isolation.levels import Deadline, Handle, Level, Spawner
from course.isolation.session import Connection, LoadRefusedError
from course.isolation.spawn import spawner

_CANARY = b"""
def canary(path):
    import os, socket
    done = []
    def attempt(name, action):
        try:
            action()
        except BaseException:
            return
        done.append(name)
    attempt("read a file of the grader's", lambda: open(path).read())
    attempt("list the folder of the grader's file", lambda: os.listdir(os.path.dirname(path)))
    attempt("open a TCP socket", lambda: socket.socket().bind(("127.0.0.1", 0)))
    attempt("open a UDP socket", lambda: socket.socket(type=socket.SOCK_DGRAM).sendto(b"x", ("127.0.0.1", 9)))
    attempt("start a process", lambda: os.fork() or os._exit(0))
    attempt("signal another process", lambda: os.kill(os.getppid() or 2, 0))
    attempt("import the course", lambda: __import__("course.physics.integrators"))
    return done
"""
_DEADLINE_S = 20.0


@dataclass(frozen=True)
class Protection:
    """The protection that this machine can enforce.

    Attributes:
        level: the strongest level that proved itself.
        causes: why the stronger ones failed, one sentence each.
        advice: ways to raise the level, one sentence each; never to switch a protection off.
    """

    level: Level
    causes: tuple[str, ...]
    advice: tuple[str, ...]


def open_spawner(
    imports: tuple[str, ...], *, at_least: Level = Level.L1, at_most: Level = Level.L3
) -> Spawner:
    """A spawner of the strongest level that proves itself within the bounds."""
    causes = []
    for level in reversed(Level):
        if at_least <= level <= at_most:
            try:
                return _proven(level, imports)
            except IsolationError as error:
                causes.append(f"{level}: {error}")
    raise IsolationError("; ".join(causes) or f"no protection level between {at_least} and {at_most}")


def probe() -> Protection:
    """Try every level from the strongest down, and report the result."""
    causes = []
    for level in (Level.L3, Level.L2):
        try:
            _proven(level, ("numpy",)).close()
        except IsolationError as error:
            causes.append(f"{level} is not available: {error}.")
        else:
            return Protection(level, tuple(causes), _advice(level))
    return Protection(Level.L1, tuple(causes), _advice(Level.L1))


def _proven(level: Level, imports: tuple[str, ...]) -> Spawner:
    """A spawner after one complete life of a canary in it."""
    if level is not Level.L1 and not sys.platform.startswith("linux"):
        raise IsolationError("it needs Linux")
    found = spawner(level, imports)
    try:
        if level is not Level.L1:
            escaped = _escapes(found)
            if escaped:
                raise IsolationError(f"a test submission could {', '.join(escaped)}")
    except BaseException:
        found.close()
        raise
    return found


def proves_itself(found: Spawner) -> bool:
    """Whether a sandbox that was in use still keeps a canary in. At L1, where nothing holds one, it does."""
    try:
        return found.level is Level.L1 or not _escapes(found)
    except IsolationError:
        return False


def _escapes(found: Spawner) -> list[str]:
    with tempfile.TemporaryDirectory(prefix="course-canary-") as folder:
        secret = Path(folder) / "secret"
        secret.write_text("secret", "utf-8")
        # Readable to every user, so that only the lockdown protects it from the canary.
        Path(folder).chmod(0o755)
        secret.chmod(0o644)
        try:
            connection = Connection(found, {"canary.py": _CANARY}, "canary.py", Deadline(_DEADLINE_S))
            try:
                done = connection.call("canary", str(secret))
            finally:
                connection.close()
        except (LoadRefusedError, StudentFailure) as error:
            raise IsolationError(f"a test submission did not run: {error}") from None
    return [str(item) for item in done] if isinstance(done, list) else ["answer in another form"]


def _advice(level: Level) -> tuple[str, ...]:
    if level is Level.L3:
        return ()
    if not sys.platform.startswith("linux"):
        return ("Grade a class on Linux: there L3 is available. Your own checks are fine as they are.",)
    if shutil.which("bwrap") is None:
        return (f"Install bubblewrap for L3: {_install_bubblewrap()}",)
    if Path("/proc/sys/kernel/apparmor_restrict_unprivileged_userns").exists():
        return ("This system lets only chosen programs use user namespaces; L2 is the level meant for it.",)
    return ("A container often forbids namespaces; L3 needs the host, or a container that allows them.",)


def _install_bubblewrap() -> str:
    managers = {"apt-get": "sudo apt-get install", "dnf": "sudo dnf install", "pacman": "sudo pacman -S"}
    for manager, command in {**managers, "zypper": "sudo zypper install", "apk": "doas apk add"}.items():
        if shutil.which(manager):
            root = hasattr(os, "getuid") and os.getuid() == 0
            return f"{command} bubblewrap".replace("sudo ", "" if root else "sudo ")
    return "the package bubblewrap"


# ---
# Sandboxes that sessions take over from each other, where one process opens many, one after the other.
#
# Starting one costs half a second. Each submission has a worker of its own in it, whichever session asks, and
# who takes one over has it prove itself once more.


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
