"""A class folder, read as data: whose submission for which exercise, or why there is none.

    SUBMISSIONS/<student>/<module>.py
    SUBMISSIONS/<student>/<exercise-id>/<module>.py
    SUBMISSIONS/<student>/<anything>.zip        as ``course submit`` writes it

Only files an exercise declares are read. Links, devices, bombs and paths that lead elsewhere are refused
with a reason that reaches the report; nothing here executes, unpacks to disk or follows anything.
"""

from __future__ import annotations

import contextlib
import functools
import hashlib
import json
import os
import stat
import zipfile
import zlib
from dataclasses import dataclass
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING, Any, TypeVar

from course.errors import NotFoundError, UngradableError
from course.grading.session import Submission
from course.grading.verdict import Problem

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from course.catalog.models import Exercise

__all__ = ["Entry", "read_class", "read_quiz", "read_student", "students"]

T = TypeVar("T")

MAX_FILE = 1 << 20
MAX_FILES = 20
MAX_UNPACKED = 5 << 20
MAX_ARCHIVE = 6 << 20  # an archive of files within the limits is never larger
FORMAT_VERSION = 1

_ARCHIVES = (".zip", ".tar", ".gz", ".tgz", ".bz2", ".xz", ".7z", ".rar", ".whl", ".jar")
_IGNORED = frozenset(
    {
        "__MACOSX", "__pycache__", ".DS_Store", ".git", ".idea", ".ipynb_checkpoints", ".svn", ".vscode",
        "Thumbs.db", "desktop.ini",
    }
)  # fmt: skip


@dataclass(frozen=True)
class Entry:
    """One student and one exercise.

    Attributes:
        student: the folder's name, as text that any file format can hold.
        submission: what is to be graded; None if there is nothing.
        problem: why there is nothing; None together with ``submission`` None means it was not handed in.
    """

    student: str
    exercise: Exercise
    submission: Submission | None = None
    problem: Problem | None = None

    @property
    def sha256(self) -> str:
        """Digest of the submission; of nothing where there is none."""
        return self.submission.sha256 if self.submission else hashlib.sha256().hexdigest()


class _RefusedError(Exception):
    """One candidate cannot be read."""

    def __init__(self, code: str, message: str, advice: str) -> None:
        super().__init__(message)
        self.problem = Problem(code, message, advice)


def read_class(folder: Path, exercises: Sequence[Exercise], *, required: bool) -> Iterator[Entry]:
    """Every student's entries, students in order of name.

    Args:
        required: whether an exercise without a file is ungradable (it was asked for by name) or merely
            not submitted.

    Raises:
        NotFoundError: there is no such folder.
    """
    for student, path in students(folder):
        yield from read_student(student, path, exercises, required=required)


def students(folder: Path) -> list[tuple[str, Path]]:
    """Names and folders of the class, sorted; names are made unique where the file system's are not text."""
    try:
        names = sorted(os.listdir(os.fsencode(folder)))  # noqa: PTH208 - bytes: a name need not be text
    except OSError as error:
        raise NotFoundError(
            f"{folder} is not a folder of submissions: {error.strerror}.",
            help="Name the folder that holds one folder per student.",
            code="submissions_not_found",
        ) from None
    found: dict[str, Path] = {}
    for raw in names:
        path = Path(os.fsdecode(os.path.join(os.fsencode(folder), raw)))  # noqa: PTH118 - bytes
        if os.fsdecode(raw) in _IGNORED or not (path.is_dir() or path.is_symlink()):
            continue
        name = raw.decode("utf-8", "backslashreplace")
        while name in found:
            name += "'"
        found[name] = path
    return list(found.items())


def read_student(
    student: str, folder: Path, exercises: Sequence[Exercise], *, required: bool
) -> Iterator[Entry]:
    """The entries of one student's folder, one per exercise."""
    try:
        if folder.is_symlink():
            raise _RefusedError("symlink", "The student's folder is a link.", "Hand in the folder itself.")
        archives = _archives(folder)
    except _RefusedError as refused:
        for exercise in exercises:
            yield Entry(student, exercise, problem=refused.problem)
        return
    except OSError as error:
        problem = Problem(
            "unreadable", f"The student's folder cannot be read: {error.strerror}.", _PERMISSIONS
        )
        for exercise in exercises:
            yield Entry(student, exercise, problem=problem)
        return
    for exercise in exercises:
        try:
            submission = _find(folder, archives, exercise)
        except _RefusedError as refused:
            yield Entry(student, exercise, problem=refused.problem)
        else:
            if submission is None and required:
                yield Entry(student, exercise, problem=_no_file(exercise))
            else:
                yield Entry(student, exercise, submission)


_PERMISSIONS = "Check the permissions of the file and of the folders above it."


def _no_file(exercise: Exercise) -> Problem:
    return Problem(
        "no_file",
        f"There is no {exercise.module} for {exercise.id}.",
        f"Put it at {exercise.module} or {exercise.id}/{exercise.module} in the student's folder, or hand in "
        "the zip that `course submit` writes.",
    )


def _archives(folder: Path) -> list[Path]:
    return sorted(path for path in folder.iterdir() if path.suffix.lower() == ".zip")


def _find(folder: Path, archives: list[Path], exercise: Exercise) -> Submission | None:
    """The one candidate for an exercise, None if there is none.

    Raises:
        _RefusedError: there are several, or the one cannot be read.
    """
    places = (folder / exercise.module, folder / exercise.id / exercise.module)
    plain = [path for path in places if os.path.lexists(path)]
    notebook = Path(exercise.module).with_suffix(".ipynb").name
    notebooks = [
        path for path in (folder / notebook, folder / exercise.id / notebook) if os.path.lexists(path)
    ]
    packed: list[tuple[Path, bytes]] = []
    for archive in archives:
        content = _from_archive(archive, exercise)
        if content is not None:
            packed.append((archive, content))
    candidates = [*plain, *(archive for archive, _ in packed)]
    if len(candidates) + len(notebooks) > 1:
        names = ", ".join(_shown(path, folder) for path in [*candidates, *notebooks])
        message = f"There are several files for {exercise.id}: {names}."
        raise _RefusedError("ambiguous_files", message, "Keep the one that counts.")
    if notebooks:
        message = f"{_shown(notebooks[0], folder)} is a notebook; {exercise.module} is what is graded."
        raise _RefusedError("notebook", message, f"Save the functions as {exercise.module}.")
    if plain:
        for part in plain[0].relative_to(folder).parents:
            if part.name and (folder / part).is_symlink():
                raise _RefusedError("symlink", f"{part} is a link.", "Hand in the folder itself.")
        return _submission(exercise, _read_regular(plain[0], _shown(plain[0], folder)))
    return _submission(exercise, packed[0][1]) if packed else None


def _submission(exercise: Exercise, content: bytes) -> Submission:
    if not content.strip():
        advice = "Was it saved before it was handed in?"
        raise _RefusedError("empty_file", f"{exercise.module} is empty.", advice)
    return Submission({exercise.module: content})


def _shown(path: Path, folder: Path) -> str:
    return os.fsencode(path.relative_to(folder)).decode("utf-8", "backslashreplace")


def _read_regular(path: Path, shown: str) -> bytes:
    """The content of a regular file within the limit; opening neither follows a link nor waits for a pipe."""
    try:
        status = path.lstat()
        if stat.S_ISLNK(status.st_mode):
            raise _RefusedError("symlink", f"{shown} is a link.", "Hand in the file itself.")
        if not stat.S_ISREG(status.st_mode):
            raise _RefusedError("not_a_file", f"{shown} is not a regular file.", "Hand in the file itself.")
        flags = os.O_RDONLY | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_NONBLOCK", 0)
        with open(os.open(path, flags | getattr(os, "O_BINARY", 0)), "rb") as handle:  # noqa: PTH123
            content = handle.read(MAX_FILE + 1)
    except OSError as error:
        message = f"{shown} cannot be read: {error.strerror or error}."
        raise _RefusedError("unreadable", message, _PERMISSIONS) from None
    if len(content) > MAX_FILE:
        raise _RefusedError("too_large", f"{shown} is larger than 1 MB.", "Hand in source code only.")
    return content


def read_quiz(folder: Path) -> Any:
    """The quiz attempts of a student's submission, as JSON gave them; an empty list if there are none.

    An archive that cannot be read gives none: the exercises in it report what is wrong with it.

    Raises:
        UngradableError: several archives hold attempts.
    """
    found: list[Any] = []
    with contextlib.suppress(OSError, _RefusedError):
        if folder.is_symlink():
            return []
        for path in _archives(folder):
            with contextlib.suppress(_RefusedError):
                record = _opened(path, functools.partial(_manifest, path)).get("quiz")
                found += [record] if record else []
    if len(found) > 1:
        raise UngradableError(
            "Several archives hold quiz attempts.", help="Keep the one that counts.", code="ambiguous_files"
        )
    return found[0] if found else []


# -- archives -----------------------------------------------------------------------------------------


def _from_archive(path: Path, exercise: Exercise) -> bytes | None:
    """The exercise's module out of a zip; None if it is not in there.

    Raises:
        _RefusedError: the archive is one that must not be opened further, or is damaged.
    """

    def read(archive: zipfile.ZipFile, members: dict[str, zipfile.ZipInfo]) -> tuple[Any, Any, bytes]:
        manifest = _manifest(path, archive, members)
        wanted = members.get(f"{exercise.id}/{exercise.module}") or members.get(exercise.module)
        return manifest, wanted, _unpacked(path, archive, wanted) if wanted else b""

    manifest, wanted, content = _opened(path, read)
    if wanted is None:
        return None
    expected = manifest.get("files", {}).get(wanted.filename)
    if manifest and expected != hashlib.sha256(content).hexdigest():
        raise _RefusedError(
            "checksum_mismatch",
            f"{wanted.filename} in {path.name} is not the file that `course submit` put there.",
            "Make the archive again with `course submit` and upload it unchanged.",
        )
    return content


def _opened(path: Path, read: Callable[[zipfile.ZipFile, dict[str, zipfile.ZipInfo]], T]) -> T:
    """What ``read`` makes of an archive whose members were all found harmless.

    Raises:
        _RefusedError: the archive must not be opened further, or is damaged.
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


def _refused(path: Path, why: str) -> _RefusedError:
    name = os.fsencode(path.name).decode("utf-8", "backslashreplace")
    return _RefusedError("refused_archive", f"{name}: {why}.", "Hand in the zip that `course submit` writes.")


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
    return any(part in _IGNORED for part in PurePosixPath(name).parts)


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
            raise _RefusedError(
                "newer_format",
                f"{path.name} was written by a newer version of this course.",
                "Update the course on the machine that grades.",
            )
        case {"format_version": int(), "files": dict(files)} if files or manifest.get("quiz"):
            return dict(manifest)
    raise _refused(path, "its submission.json is damaged")
