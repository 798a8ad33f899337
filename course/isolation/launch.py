"""Shared by all ways of starting a worker: its files, its command, cleaning up after it."""

from __future__ import annotations

import contextlib
import json
import os
import secrets
import shutil
import sys
import tempfile
from pathlib import Path
from time import monotonic
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Iterator

    from course.isolation.view import View

__all__ = [
    "command",
    "copy_worker_files",
    "environment",
    "keep_private",
    "private_folder",
    "remove_tree",
    "removing",
    "sweep",
    "sweep_after_the_dead",
    "tidy",
]

#: What runs beside a stranger's code is copied as a package of its own, laid out as here: its files import
#: each other by the same relative names in both places.
_PACKAGE = "course_worker"
_COPIED = (
    *(f"isolation/inside/{name}.py" for name in ("frames", "encoding", "decoding", "wire")),
    *(f"isolation/inside/{name}.py" for name in ("loops", "statements", "declared", "loading")),
    *(f"isolation/inside/{name}.py" for name in ("worker", "lockdown", "zygote")),
    "physics/systems.py",
)
_PREFIX = "course-worker-"
_TIDY_S = 1.0
_SWEEP_S = 5.0  # wall seconds spent on deleting what a submission left behind


def keep_private() -> None:
    """Close this process to others of the same user: its memory, its descriptors, its environment.

    At L1 a submission runs as that user, and through /proc it could open the pipe that verdicts go through.
    Only Linux has /proc, and the one call that closes it.
    """
    if sys.platform == "linux":
        from course.isolation.inside import lockdown

        lockdown.not_dumpable()


def private_folder() -> Path:
    """A new folder for one session, named after this process."""
    sweep_after_the_dead()
    return Path(tempfile.mkdtemp(prefix=f"{_PREFIX}{os.getpid()}-"))


def sweep_after_the_dead() -> None:
    """Delete what killed processes left behind: the folders whose process is gone."""
    if hasattr(os, "getuid"):  # on Windows, asking whether a process lives would end it
        for old in Path(tempfile.gettempdir()).glob(f"{_PREFIX}*"):
            owner = old.name.removeprefix(_PREFIX).partition("-")[0]
            with contextlib.suppress(OSError):
                if owner.isdigit() and old.lstat().st_uid == os.getuid() and not _is_alive(int(owner)):
                    sweep(old)


def _is_alive(pid: int) -> bool:
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    except OSError:
        return True
    return True


def copy_worker_files(target: Path) -> None:
    """Put the worker's files into a folder that the worker's user can read."""
    course = Path(__file__).resolve().parents[1]
    package = target / _PACKAGE
    for folder in (package, package / "isolation", package / "isolation" / "inside", package / "physics"):
        folder.mkdir()
        (folder / "__init__.py").touch()
    for name in _COPIED:
        shutil.copy(course / name, package / name)
    for path in (package, *package.rglob("*")):
        path.chmod(0o755 if path.is_dir() else 0o644)


def command(view: View, folder: str, config: dict[str, Any]) -> list[str]:
    # -S and -s: no site-packages, so nothing but the declared packages on the path; -P: no current folder.
    flags = ["-S", "-s", "-P", "-B"]
    zygote = f"{folder}/{_PACKAGE}/isolation/inside/zygote.py"
    return [str(view.interpreter), *flags, zygote, json.dumps(config)]


def environment() -> dict[str, str]:
    kept = {
        name: os.environ[name]
        for name in ("SYSTEMROOT", "PATH")
        if name in os.environ and sys.platform == "win32"
    }
    threads = {f"{name}_NUM_THREADS": "1" for name in ("OPENBLAS", "OMP", "MKL", "VECLIB_MAXIMUM")}
    return {**kept, **threads, "LANG": "C.UTF-8", "HOME": "/nonexistent", "PYTHONHASHSEED": "0"}


def sweep(folder: Path) -> None:
    """Delete the folder of a session that ends; a later session deletes what remains."""
    _advance(removing(folder), _SWEEP_S)


def tidy(left: list[Iterator[None]]) -> None:
    """Continue some removals for a second of wall time, and remove the finished ones from the list.

    Deleting can take longer than making did, and a run must not stand still for that.
    """
    end = monotonic() + _TIDY_S
    while left and _advance(left[-1], end - monotonic()):
        left.pop()


def _advance(removal: Iterator[None], seconds: float) -> bool:
    """Whether a removal is done within so much time."""
    end = monotonic() + seconds
    return all(monotonic() < end for _ in removal)


def remove_tree(folder: Path) -> None:
    """Delete a folder that a submission filled, however long it takes."""
    for _ in removing(folder):
        pass


def removing(folder: Path) -> Iterator[None]:
    """Delete a folder that a submission filled: of any depth, with any permissions, with links to anywhere.

    Folders inside folders are moved up before they are emptied, so that neither the length of a path nor
    recursion sets a limit. Yields after each entry, so that the caller can continue later.
    """
    moved, prefix = 0, secrets.token_hex(8)  # a name that the submission cannot have used
    pending = [folder]
    while pending:
        here = pending.pop()
        entries: list[os.DirEntry[str]] = []
        with contextlib.suppress(OSError):
            here.chmod(0o700)
            entries = list(os.scandir(here))
        for entry in entries:
            with contextlib.suppress(OSError):  # an entry that cannot be deleted does not keep the others
                if entry.is_dir(follow_symlinks=False):
                    moved += 1
                    os.chmod(entry.path, 0o700)  # noqa: PTH101 - moving a folder needs to write to it
                    os.rename(entry.path, folder / f"{prefix}-{moved}")  # noqa: PTH104
                    pending.append(folder / f"{prefix}-{moved}")
                else:
                    os.unlink(entry.path)  # noqa: PTH108
            yield
        if here != folder:
            with contextlib.suppress(OSError):
                here.rmdir()
    with contextlib.suppress(OSError):
        folder.rmdir()
