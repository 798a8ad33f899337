"""Zip archives as students hand them in, read as data: nothing is unpacked to disk, nothing is believed.

Links, devices, bombs and paths that lead elsewhere are refused with a reason that reaches the report.
"""

from __future__ import annotations

import contextlib
import functools
import hashlib
import json
import stat
import zipfile
import zlib
from pathlib import PurePosixPath
from typing import TYPE_CHECKING, Any, TypeVar

from course.grading.intake.downloads import IGNORED
from course.printable import one_line
from course.scoring.verdict import Problem

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from course.catalog.models import Exercise

__all__ = ["MAX_FILE", "RefusedError", "manifest_of", "module_in"]

T = TypeVar("T")

MAX_FILE = 1 << 20
MAX_FILES = 20
MAX_UNPACKED = 5 << 20
MAX_ARCHIVE = 6 << 20  # an archive of files within the limits is never larger
FORMAT_VERSION = 1

_ARCHIVES = (".zip", ".tar", ".gz", ".tgz", ".bz2", ".xz", ".7z", ".rar", ".whl", ".jar")


class RefusedError(Exception):
    """One candidate cannot be read."""

    def __init__(self, code: str, message: str, advice: str) -> None:
        super().__init__(message)
        self.problem = Problem(code, one_line(message), advice)


def manifest_of(path: Path) -> dict[str, Any]:
    """What ``course submit`` wrote beside the files of an archive; empty for one made by hand.

    Raises:
        RefusedError: the archive must not be opened, or is damaged.
    """
    return _opened(path, functools.partial(_manifest, path))


def module_in(path: Path, exercise: Exercise) -> tuple[str, bytes] | None:
    """What a zip holds for an exercise, its module or a notebook: name and content; None if there is neither.

    Raises:
        RefusedError: the archive is one that must not be opened further, or is damaged, or holds several.
    """

    def read(archive: zipfile.ZipFile, members: dict[str, zipfile.ZipInfo]) -> tuple[Any, Any, bytes]:
        manifest = _manifest(path, archive, members)
        wanted = _wanted(path, members, exercise)
        return manifest, wanted, _unpacked(path, archive, wanted) if wanted else b""

    manifest, wanted, content = _opened(path, read)
    if wanted is None:
        return None
    expected = manifest.get("files", {}).get(wanted.filename)
    if manifest and expected != hashlib.sha256(content).hexdigest():
        raise RefusedError(
            "checksum_mismatch",
            f"{wanted.filename} in {path.name} is not the file that `course submit` put there.",
            "Make the archive again with `course submit` and upload it unchanged.",
        )
    return wanted.filename, content


def _wanted(path: Path, members: dict[str, zipfile.ZipInfo], exercise: Exercise) -> zipfile.ZipInfo | None:
    """The one member for an exercise; None if there is none."""
    found = []
    for name in (exercise.module, PurePosixPath(exercise.module).with_suffix(".ipynb").name):
        member = members.get(f"{exercise.id}/{name}") or members.get(name)
        found += [member] if member else []
    if len(found) > 1:
        names = " and ".join(member.filename for member in found)
        message = f"{path.name} holds several files for {exercise.id}: {names}."
        raise RefusedError("ambiguous_files", message, "Keep the one that counts.")
    return found[0] if found else None


def _opened(path: Path, read: Callable[[zipfile.ZipFile, dict[str, zipfile.ZipInfo]], T]) -> T:
    """What ``read`` makes of an archive whose members were all found harmless.

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
    except (zipfile.BadZipFile, zlib.error, RuntimeError, NotImplementedError, EOFError, ValueError) as error:
        raise _refused(path, f"it cannot be read ({error})") from None
    except OSError as error:
        raise _refused(path, f"it cannot be read ({error.strerror or error})") from None


def _refused(path: Path, why: str) -> RefusedError:
    return RefusedError(
        "refused_archive", f"{path.name}: {why}.", "Hand in the zip that `course submit` writes."
    )


def _checked_members(path: Path, infos: list[zipfile.ZipInfo]) -> dict[str, zipfile.ZipInfo]:
    """The members by name, after every one of them was found harmless."""
    files = [info for info in infos if not info.is_dir() and not _is_clutter(info.filename)]
    if len(files) > MAX_FILES:
        raise _refused(path, f"it holds more than {MAX_FILES} files")
    if sum(info.file_size for info in files) > MAX_UNPACKED:
        raise _refused(path, "it unpacks to more than 5 MB")
    members: dict[str, zipfile.ZipInfo] = {}
    for info in files:
        name = PurePosixPath(info.filename)
        kind = stat.S_IFMT(info.external_attr >> 16)
        if name.is_absolute() or ".." in name.parts or "\\" in info.filename or ":" in info.filename:
            raise _refused(path, "a file in it has a path that leads outside")
        if kind not in (0, stat.S_IFREG):
            raise _refused(path, "it holds a link or a device")
        if info.flag_bits & 1:
            raise _refused(path, "it is encrypted")
        if name.suffix.lower() in _ARCHIVES:
            raise _refused(path, "it holds another archive")
        if info.filename in members:
            raise _refused(path, "it holds two files of one name")
        members[info.filename] = info
    return members


def _is_clutter(name: str) -> bool:
    """What operating systems add to a zip by themselves."""
    return any(part in IGNORED for part in PurePosixPath(name).parts)


def _unpacked(path: Path, archive: zipfile.ZipFile, info: zipfile.ZipInfo) -> bytes:
    """A member's content; the size its header claims is not believed."""
    with archive.open(info) as handle:
        content = handle.read(MAX_FILE + 1)
    if len(content) > MAX_FILE:
        raise _refused(path, f"{info.filename} unpacks to more than 1 MB")
    return content


def _manifest(path: Path, archive: zipfile.ZipFile, members: dict[str, zipfile.ZipInfo]) -> dict[str, Any]:
    """What ``course submit`` wrote beside the files; empty for an archive made by hand."""
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
