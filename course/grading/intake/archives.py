"""Zip archives from students, read as data: nothing is unpacked to disk, and nothing in them is trusted.

Links, devices, bombs and paths that lead elsewhere are refused with a reason that reaches the report. A
folder around everything, and the backslashes of Windows, are accepted and noted.
"""

from __future__ import annotations

import contextlib
import functools
import hashlib
import json
import stat
import zipfile
from dataclasses import dataclass
from pathlib import PurePosixPath
from typing import TYPE_CHECKING, Any, TypeVar

from course.grading.intake.downloads import IGNORED
from course.grading.intake.names import is_meant
from course.printable import one_line
from course.scoring.verdict import Problem

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path

    from course.catalog.models import Exercise

__all__ = [
    "MAX_FILE",
    "ArchiveContent",
    "RefusedError",
    "manifest_of",
    "member_of",
    "module_in",
    "outline_of",
]

T = TypeVar("T")
Members = dict[str, zipfile.ZipInfo]

MAX_FILE = 1 << 20
MAX_FILES = 20
MAX_UNPACKED = 5 << 20
MAX_ARCHIVE = 6 << 20  # no archive of files within the limits is larger
FORMAT_VERSION = 1

_ARCHIVES = (".zip", ".tar", ".gz", ".tgz", ".bz2", ".xz", ".7z", ".rar", ".whl", ".jar")


class RefusedError(Exception):
    """One candidate cannot be read."""

    def __init__(self, code: str, message: str, advice: str) -> None:
        super().__init__(message)
        self.problem = Problem(code, one_line(message), advice)


def manifest_of(path: Path) -> dict[str, Any]:
    """The metadata that ``course submit`` put into an archive; empty for one made by hand.

    Raises:
        RefusedError: the archive must not be opened, or is damaged.
    """
    return _opened(path, functools.partial(_manifest, path))


@dataclass(frozen=True)
class ArchiveContent:
    """An archive's file for an exercise.

    Attributes:
        name: in the archive.
        notes: assumptions that were made, one sentence each.
        copies: the members that are the same file, this one included.
    """

    name: str
    content: bytes
    notes: tuple[str, ...] = ()
    copies: tuple[str, ...] = ()


def module_in(path: Path, exercise: Exercise) -> ArchiveContent | None:
    """A zip's module or notebook for an exercise; None if there is neither.

    Raises:
        RefusedError: the archive must not be opened further, is damaged, or holds several.
    """

    def read(archive: zipfile.ZipFile, members: Members) -> ArchiveContent | None:
        manifest = _manifest(path, archive, members)
        wanted = _wanted(members, exercise)
        if not wanted:
            return None
        contents = {name: _unpacked(path, archive, members[name]) for name in wanted}
        if len(set(contents.values())) > 1:
            message = f"{path.name} holds several files for {exercise.id}: {' and '.join(wanted)}."
            raise RefusedError("ambiguous_files", message, "Keep the one that counts.")
        name, content = next(iter(contents.items()))
        listed = manifest.get("files", {})
        expected = listed.get(name, listed.get(members[name].filename))
        if manifest and expected != hashlib.sha256(content).hexdigest():
            raise RefusedError(
                "checksum_mismatch",
                f"{name} in {path.name} is not the file that `course submit` put there.",
                "Make the archive again with `course submit` and upload it unchanged.",
            )
        raw = members[name].filename
        notes = tuple(one_line(note) for note in _notes(path, name, raw, wanted, exercise))
        return ArchiveContent(raw, content, notes, tuple(members[other].filename for other in wanted))

    return _opened(path, read)


def _notes(path: Path, name: str, raw: str, wanted: list[str], exercise: Exercise) -> Iterator[str]:
    """The assumptions made about a member."""
    around = raw.replace("\\", "/").removesuffix(name).strip("/").removesuffix(exercise.place).strip("/")
    if around:
        yield f"Everything in {path.name} lies in the folder {around}, which was passed over."
    if "\\" in raw:
        yield f"{path.name} has backslashes in its paths; they were taken for folders."
    base = PurePosixPath(name).name
    if base not in {exercise.module, PurePosixPath(exercise.module).with_suffix(".ipynb").name}:
        yield f"{base} was taken for {exercise.module}."
    if len(wanted) > 1:
        yield f"The same file is in {path.name} {len(wanted)} times: {', '.join(wanted)}."


def _wanted(members: Members, exercise: Exercise) -> list[str]:
    """The members for an exercise, those with exactly its name first."""
    names = (exercise.module, PurePosixPath(exercise.module).with_suffix(".ipynb").name)
    found = [
        name
        for name in members
        if PurePosixPath(name).parent.as_posix() in {".", exercise.place}
        and any(is_meant(PurePosixPath(name).name, wanted) for wanted in names)
    ]
    return sorted(found, key=lambda name: (PurePosixPath(name).name not in names, "/" not in name, name))


def outline_of(path: Path, skip: tuple[str, ...]) -> list[tuple[str, bytes]]:
    """Names and contents of the modules and notebooks in a zip, except those to skip.

    Raises:
        RefusedError: it must not be opened further, or is damaged.
    """

    def read(archive: zipfile.ZipFile, members: Members) -> list[tuple[str, bytes]]:
        return [
            (info.filename, _unpacked(path, archive, info))
            for info in members.values()
            if info.filename not in skip and info.filename.casefold().endswith((".py", ".ipynb"))
        ]

    return _opened(path, read)


def member_of(path: Path, name: str) -> bytes:
    """The content of one member, by the name the zip has for it, or that name with plain slashes.

    Raises:
        RefusedError: there is none, or the archive must not be opened further.
    """

    def read(archive: zipfile.ZipFile, members: Members) -> bytes:
        for plain, info in members.items():
            if name in {info.filename, info.filename.replace("\\", "/"), plain}:
                return _unpacked(path, archive, info)
        raise RefusedError("no_file", f"{path.name} holds no {name}.", "Name a file that is in it.")

    return _opened(path, read)


def _opened(path: Path, read: Callable[[zipfile.ZipFile, Members], T]) -> T:
    """The result of ``read`` on an archive whose members are all harmless.

    Raises:
        RefusedError: the archive must not be opened further, or is damaged.
    """
    try:
        if not stat.S_ISREG(path.lstat().st_mode):
            raise _refused(path, "it is not a regular file")
        if path.stat().st_size > MAX_ARCHIVE:
            raise _refused(path, "it is larger than 6 MB")
        with zipfile.ZipFile(path) as archive:
            return read(archive, _checked_members(path, archive.infolist()))
    except RefusedError:
        raise
    except OSError as error:
        raise _refused(path, f"it cannot be read ({error.strerror or error})") from None
    except Exception as error:  # noqa: BLE001 - zipfile and what unpacks for it raise all kinds at damage
        raise _refused(path, f"it cannot be read ({error or type(error).__name__})") from None


def _refused(path: Path, why: str) -> RefusedError:
    return RefusedError(
        "refused_archive", f"{path.name}: {why}.", "Hand in the zip that `course submit` writes."
    )


def _checked_members(path: Path, infos: list[zipfile.ZipInfo]) -> Members:
    """The members by name, without the folders around all of them; every one is harmless."""
    files = [info for info in infos if not info.is_dir() and not _is_clutter(info.filename)]
    if len(files) > MAX_FILES:
        raise _refused(path, f"it holds more than {MAX_FILES} files")
    if sum(info.file_size for info in files) > MAX_UNPACKED:
        raise _refused(path, "it unpacks to more than 5 MB")
    members: Members = {}
    for info in files:
        name = PurePosixPath(info.filename.replace("\\", "/"))
        kind = stat.S_IFMT(info.external_attr >> 16)
        if name.is_absolute() or ".." in name.parts or ":" in info.filename:
            raise _refused(path, "a file in it has a path that leads outside")
        if kind not in (0, stat.S_IFREG):
            raise _refused(path, "it holds a link or a device")
        if info.flag_bits & 1:
            raise _refused(path, "it is encrypted")
        if name.suffix.lower() in _ARCHIVES:
            raise _refused(path, "it holds another archive")
        if name.as_posix() in members:
            raise _refused(path, "it holds two files of one name")
        members[name.as_posix()] = info
    return _without_top(members)


def _without_top(members: Members) -> Members:
    """The members' names without the folders around all of them."""
    while members and all("/" in name for name in members):
        tops = {name.partition("/")[0] for name in members}
        if len(tops) > 1:
            break
        members = {name.partition("/")[2]: info for name, info in members.items()}
    return members


def _is_clutter(name: str) -> bool:
    """Whether an operating system added it to the zip."""
    return any(part in IGNORED for part in PurePosixPath(name.replace("\\", "/")).parts)


def _unpacked(path: Path, archive: zipfile.ZipFile, info: zipfile.ZipInfo) -> bytes:
    """A member's content; the size in its header is not trusted."""
    with archive.open(info) as handle:
        content = handle.read(MAX_FILE + 1)
    if len(content) > MAX_FILE:
        raise _refused(path, f"{info.filename} unpacks to more than 1 MB")
    return content


def _manifest(path: Path, archive: zipfile.ZipFile, members: Members) -> dict[str, Any]:
    """The metadata that ``course submit`` wrote; empty for an archive made by hand."""
    info = members.get("submission.json")
    if info is None:
        return {}
    manifest: Any = None
    with contextlib.suppress(ValueError, RecursionError):
        manifest = json.loads(_unpacked(path, archive, info))
    match manifest:
        case {"format_version": int(version)} if version > FORMAT_VERSION:
            raise RefusedError(
                "newer_format",
                f"{path.name} was written by a newer version of this course.",
                "Update the course on the machine that grades.",
            )
        case {"format_version": int(), "files": dict(files)} if files or manifest.get("quiz"):
            return dict(manifest)
    raise _refused(path, "its submission.json is damaged")
