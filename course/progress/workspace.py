"""A student's workspace: ``course.toml``, the exercises being worked on, and ``.course/``.

The rule of this module: nothing is overwritten without a copy kept. A new file is created only where none
is; an existing one is replaced only after ``backup`` has returned the place of its copy.

    course.toml                    which course, which version
    <exercise-id>/<module>.py      the student's
    .course/progress.sqlite        the record (course.progress.store)
    warm-ups/<id>/<module>.py      the same of a warm-up
    .course/given/<place>/         every file as it was handed out, by the folder it lies in
    .course/backups/<when>-<why>/  what reset, update and submit replaced
"""

from __future__ import annotations

import contextlib
import os
import re
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from typing import Any

from course.errors import ContentError, CourseError, MissingCapabilityError, NotFoundError, UsageError
from course.ids import WARM_UPS
from course.progress.store import Store, gone, numbered
from course.strangers import read_bytes, toml

MARKER = "course.toml"
FORMAT_VERSION = 1

_TEMPLATE = """\
# A workspace of the course. The files in the folders beside this one are yours; .course holds the
# record of your progress and a copy of everything a command ever replaced.
format_version = {format_version}

[course]
id = "{course_id}"
version = "{version}"
"""
_NOT_FOR_GIT = """\
# What git need not keep: your progress and old copies, what Python and Jupyter leave, what you hand in.
.course/
__pycache__/
.ipynb_checkpoints/
*-submission.zip
"""
#: Bytes of a file that was handed out; the largest has a thirtieth.
_MOST_GIVEN = 1 << 18
_VERSION_LINE = re.compile(r'^(version\s*=\s*)"[^"\n]*"', re.MULTILINE)


@dataclass(frozen=True, slots=True)
class Workspace:
    """A folder that holds a ``course.toml``.

    Attributes:
        root: the folder, absolute.
        course_id: the course it belongs to.
        version: version of the content last put into it.
    """

    root: Path
    course_id: str
    version: str

    @classmethod
    def find(cls, start: Path) -> Workspace:
        """The workspace that ``start`` lies in.

        Raises:
            NotFoundError: neither ``start`` nor a folder above it is one.
            ContentError: its ``course.toml`` cannot be used.
            MissingCapabilityError: it was made by a newer version of the course.
        """
        for folder in (start, *start.parents):
            if (folder / MARKER).is_file():
                return cls.read(folder)
        problem = "This folder is not inside a workspace."
        fix = "Make one with `course init my-course`, or name one with `-C DIR`."
        raise NotFoundError(problem, help=fix, code="workspace_not_found")

    @classmethod
    def read(cls, root: Path) -> Workspace:
        """The workspace at ``root``; raises what ``find`` raises."""
        marker = root / MARKER
        try:
            # An editor of another system may have put a byte-order mark in front; TOML allows none.
            table = toml(read_bytes(marker).decode("utf-8-sig"))
        except tomllib.TOMLDecodeError as error:
            line = re.search(r"line (\d+)", str(error))
            problem = f"not valid TOML: {error}."
            raise _bad_marker(marker, int(line[1]) if line else None, problem) from error
        except (OSError, UnicodeDecodeError) as error:
            raise _bad_marker(marker, None, f"cannot be read: {error}.") from error
        version = table.get("format_version")
        if isinstance(version, int) and version > FORMAT_VERSION:
            said = f"{marker} was written by a newer version of the course (format {version})."
            fix = "Install that version or a later one; nothing here was touched."
            raise MissingCapabilityError(said, help=fix, code="workspace_too_new")
        course = table.get("course")
        if version != FORMAT_VERSION or not isinstance(course, dict):
            raise _bad_marker(marker, None, "format_version or [course] is missing.")
        name, content = course.get("id"), course.get("version")
        if not isinstance(name, str) or not isinstance(content, str):
            raise _bad_marker(marker, None, "[course] needs an id and a version, both strings.")
        return cls(root=root, course_id=name, version=content)

    @classmethod
    def create(cls, root: Path, course_id: str, version: str) -> Workspace:
        """Make a workspace at ``root``, which may exist already and keeps everything in it.

        Raises:
            UsageError: ``root`` is a file, or there is a ``course.toml``.
            MissingCapabilityError: the folder cannot be written.
        """
        text = _TEMPLATE.format(format_version=FORMAT_VERSION, course_id=course_id, version=version)
        try:
            root.mkdir(parents=True, exist_ok=True)
            (root / ".course").mkdir(exist_ok=True)
            _write_new(root / MARKER, text.encode())
            with contextlib.suppress(FileExistsError):
                _write_new(root / ".gitignore", _NOT_FOR_GIT.encode())
        except FileExistsError as error:
            fix = "Move it away, or name another folder."
            raise UsageError(f"{error.filename} is in the way.", help=fix, code="exists") from None
        except OSError as error:
            raise _not_writable(root, error) from error
        return cls(root=root, course_id=course_id, version=version)

    @property
    def state(self) -> Path:
        """The folder for what the course itself keeps here."""
        return self.root / ".course"

    @property
    def store(self) -> Store:
        return Store(self.state / "progress.sqlite")

    def path(self, place: str, name: str) -> Path:
        """Where a file belongs that lies in this folder: an exercise's id, or what its ``place`` says."""
        return self.root / place / name

    def must_be_there(self) -> None:
        """Raise MissingCapabilityError where it was moved or removed since it was found."""
        if not (self.root / MARKER).is_file():
            raise gone(self.root)

    def has_file(self, place: str, module: str) -> bool:
        """Whether an exercise's module or notebook is there; where that cannot be seen, yes."""
        with contextlib.suppress(OSError):
            return any(self.path(place, module).with_suffix(kind).exists() for kind in (".py", ".ipynb"))
        return True

    def shown(self, path: Path) -> str:
        """``path`` as a person wants to read it: relative to the workspace where it lies inside."""
        with contextlib.suppress(ValueError):
            return path.relative_to(self.root).as_posix()
        return str(path)

    def given(self, place: str, name: str) -> bytes | None:
        """A file as it was last handed out; None if it never was."""
        with contextlib.suppress(OSError):
            return read_bytes(self._given_path(place, name), _MOST_GIVEN)
        return None

    def started(self) -> tuple[str, ...]:
        """Ids of the exercises that something was handed out for."""
        given = self.state / "given"
        names: list[str] = []
        for folder in (given, given / WARM_UPS):
            with contextlib.suppress(OSError):
                names += (entry.name for entry in folder.iterdir() if entry.is_dir())
        return tuple(sorted(name for name in names if name != WARM_UPS))

    def begun(self) -> tuple[str, ...]:
        """Those, and the folders with code: a clone of the workspace has the files without their record."""
        names = set(self.started())
        for folder in (self.root, self.root / WARM_UPS):
            with contextlib.suppress(OSError):
                own = (entry for entry in folder.iterdir() if entry.is_dir() and entry.name[0] != ".")
                names |= {one.name for one in own if any(one.glob("*.py")) or any(one.glob("*.ipynb"))}
        return tuple(sorted(names - {WARM_UPS}))

    def give(self, place: str, name: str, data: bytes) -> bool:
        """Put a file where none is, and remember how it looked; False if there is one already.

        Raises:
            MissingCapabilityError: the workspace cannot be written, or is gone.
        """
        self.must_be_there()
        target = self.path(place, name)
        try:
            target.parent.mkdir(parents=True, exist_ok=True)
            if not self._given_path(place, name).exists():
                self.remember(place, name, data)
            _write_new(target, data)
        except FileExistsError:
            return False
        except OSError as error:
            raise _not_writable(target, error) from error
        return True

    def remember(self, place: str, name: str, data: bytes) -> None:
        """Keep how a file looked when it was handed out."""
        write_atomically(self._given_path(place, name), data)

    def backup(self, path: Path, why: str) -> Path:
        """Copy ``path`` into a new folder of backups and give the copy's place.

        Raises:
            MissingCapabilityError: the copy cannot be written; ``path`` must then stay as it is.
        """
        self.must_be_there()
        stamp = datetime.now().astimezone().strftime("%Y%m%d-%H%M%S")
        relative = Path(self.shown(path)) if path.is_relative_to(self.root) else Path(path.name)
        try:
            data = path.read_bytes()
            (self.state / "backups").mkdir(parents=True, exist_ok=True)
            for folder in numbered(self.state / "backups" / f"{stamp}-{why}"):
                with contextlib.suppress(FileExistsError):
                    folder.mkdir()
                    break
            copy = folder / relative
            copy.parent.mkdir(parents=True, exist_ok=True)
            _write_new(copy, data)
        except OSError as error:
            raise _not_writable(self.state / "backups", error) from error
        return copy

    def is_newer(self, version: str) -> bool:
        """Whether a later version of the course's content was put into it than this one."""
        mine, other = ([int(part) for part in re.findall(r"\d+", one)[:3]] for one in (self.version, version))
        return mine > other

    def note_version(self, version: str) -> None:
        """Note in ``course.toml`` which version the content is from now; comments there stay."""
        marker = self.root / MARKER
        text = marker.read_text(encoding="utf-8-sig")
        write_atomically(marker, _VERSION_LINE.sub(rf'\g<1>"{version}"', text, count=1).encode())

    def _given_path(self, place: str, name: str) -> Path:
        return self.state / "given" / place / name


@dataclass
class Recorder:
    """Takes events into a record; where one cannot be kept, work goes on.

    Attributes:
        store: None where there is no workspace; events are dropped then.
        trouble: why something was not recorded, a sentence; empty while all is well.
        kept: whether the last event was recorded.
    """

    store: Store | None
    trouble: str = ""
    kept: bool = False

    @classmethod
    def of_kernel(cls, course_id: str) -> Recorder | None:
        """That of the workspace a notebook's kernel runs in, if it is this course's; None outside of one.

        Raises:
            ContentError, MissingCapabilityError: its ``course.toml`` cannot be used.
        """
        try:
            workspace = Workspace.find(Path.cwd())
        except (NotFoundError, FileNotFoundError):  # also where the folder is gone
            return None
        if workspace.course_id != course_id:
            return cls(None, f"This was not recorded: {workspace.root} is a workspace of another course.")
        return cls(workspace.store)

    def __call__(self, kind: str, subject: str, data: Mapping[str, Any]) -> None:
        self.kept = False
        if self.store is None:
            return
        try:
            self.store.append(kind, subject, data)
            self.kept = True
        except CourseError as error:
            self.trouble = not_recorded(error)


def not_recorded(error: CourseError) -> str:
    """Why an event was not recorded, for its student."""
    return f"This was not recorded: {error.message} {error.help}"


def same_text(one: bytes, other: bytes) -> bool:
    """True if two files differ in line endings or a byte-order mark at most."""
    return _normal(one) == _normal(other)


def write_atomically(path: Path, data: bytes) -> None:
    """Write a file in one step: whenever the process dies, it is either the old one or the new one.

    A symbolic link keeps pointing where it points; what it points at is replaced.

    Raises:
        MissingCapabilityError: the folder cannot be written.
    """
    target = Path(os.path.realpath(path))  # resolve() gives up at a link to itself
    scratch = target.with_name(f".{target.name}.{os.getpid()}.tmp")
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        with scratch.open("wb") as file:
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
        scratch.replace(target)
    except OSError as error:
        with contextlib.suppress(OSError):
            scratch.unlink()
        raise _not_writable(path, error) from error


def _write_new(path: Path, data: bytes) -> None:
    """Write a file that must not exist; FileExistsError if it does, even as a dangling link."""
    with path.open("xb") as file:
        file.write(data)


def _normal(data: bytes) -> bytes:
    return data.removeprefix(b"\xef\xbb\xbf").replace(b"\r\n", b"\n")


def _bad_marker(marker: Path, line: int | None, problem: str) -> ContentError:
    fix = "Correct the file, or move it away and run `course init` here again: no exercise is touched."
    error = ContentError(marker, line, problem, help=fix)
    # The file is the student's, so this is nothing to report as a fault of the course.
    error.exit_code = UsageError.exit_code
    error.code = "workspace_damaged"
    return error


def _not_writable(path: Path, error: OSError) -> CourseError:
    problem = f"{path} cannot be written ({error.strerror or error})."
    fix = "Make the folder writable or free some space, or work in another folder."
    return MissingCapabilityError(problem, help=fix, code="not_writable")
