"""Files that commands write to a given place. A copy of what was there before is kept and reported."""

from __future__ import annotations

from pathlib import Path  # noqa: TC003 - functions here take paths, and annotations are read
from typing import TYPE_CHECKING

from course.cli.frame.here import cwd
from course.errors import CourseError, UsageError

if TYPE_CHECKING:
    from course.cli.frame.replies import WrittenFile

__all__ = ["FORMATS", "inserted", "target", "write"]

#: The formats of a figure, by the suffix of its name.
FORMATS = ("png", "svg", "pdf")


def target(path: Path, option: str, endings: tuple[str, ...]) -> Path:
    """Where to write, checked before anything is computed.

    Raises:
        UsageError: the name ends in something else, or there is no such folder.
    """
    full = cwd() / path.expanduser()
    if full.suffix.lower().removeprefix(".") not in endings:
        known = " or ".join(f".{ending}" for ending in endings)
        raise UsageError(
            f"{option} {path}: the name must end in {known}.",
            help=f"For example {option} {path.stem or 'run'}.{endings[0]}.",
            code="bad_file_name",
        )
    if full.is_dir():
        raise UsageError(f"{option} {path}: this is a folder.", help="Name a file.", code="bad_file_name")
    if not full.parent.is_dir():
        raise UsageError(
            f"{option} {path}: there is no folder {full.parent}.",
            help="Make it, or name another file.",
            code="bad_file_name",
        )
    return full


def inserted(path: Path, name: str) -> Path:
    """One of several files: run.png becomes run-free-fall.png."""
    return path.with_name(f"{path.stem}-{name}{path.suffix}")


def write(path: Path, data: bytes, *, why: str = "sim") -> WrittenFile:
    """Write a file; if there is another one of that name, keep a copy of it first.

    Inside a workspace copies go where all its backups are, elsewhere beside the file.

    Raises:
        UsageError: the file cannot be written.
        MissingCapabilityError: the copy cannot be written; the file is then unchanged.
    """
    from course.cli.frame.replies import Backup, WrittenFile
    from course.progress.workspace import write_atomically

    try:
        old = path.read_bytes() if path.exists() else None
    except OSError as error:
        raise UsageError(
            f"{path} is there and cannot be read ({error.strerror or error}), so no copy of it can be kept.",
            help="Name another file.",
            code="not_writable",
        ) from error
    copy = None if old is None or old == data else _keep(path, old, why)
    write_atomically(path, data)
    return WrittenFile(path=str(path), backup=Backup(str(path), str(copy)) if copy else None)


def _keep(path: Path, old: bytes, why: str) -> Path:
    """Copy a file and give the copy's place."""
    from course.progress.workspace import Workspace

    try:
        return Workspace.find(path.parent).backup(path, why)
    except CourseError as error:
        if error.code != "workspace_not_found":
            raise
    number = 1
    while True:
        copy = path.with_name(f"{path.stem}.old-{number}{path.suffix}")
        try:
            with copy.open("xb") as file:
                file.write(old)
        except FileExistsError:
            number += 1
        except OSError as error:
            raise UsageError(
                f"{path} is there, and no copy of it can be kept ({error.strerror or error}).",
                help="Name another file.",
                code="not_writable",
            ) from error
        else:
            return copy
