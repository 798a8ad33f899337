"""Where a command runs: which course, which workspace, which exercise.

Everything a command needs to know before it starts; heavier imports wait until they are asked for.
"""

from __future__ import annotations

import csv
import io
import itertools
from collections.abc import Iterable
from contextlib import suppress
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

from course.catalog.models import CourseRef, Exercise
from course.cli.frame.console import current
from course.cli.frame.replies import Backup, Envelope, WrittenFile
from course.errors import CourseError, MissingCapabilityError, NotFoundError, UngradableError, UsageError
from course.handed_in.limits import must_fit
from course.ids import WARM_UPS
from course.progress.history import History, Standing, history_of
from course.progress.store import Event
from course.progress.workspace import Recorder, Workspace, same_text, write_atomically
from course.strangers import read_bytes

if TYPE_CHECKING:
    from course.catalog.load import Catalog


@dataclass
class Here:
    """A course and a workspace that belongs to it."""

    catalog: Catalog
    workspace: Workspace
    warnings: list[str] = field(default_factory=list)
    _told: set[str] = field(default_factory=set)

    @classmethod
    def load(cls) -> Here:
        """The course in use and the workspace of the current folder.

        Raises:
            NotFoundError: the folder is not in a workspace.
            MissingCapabilityError: the workspace is another course's.
        """
        workspace = Workspace.find(cwd())
        return cls(catalog=catalog_of(workspace), workspace=workspace)

    @cached_property
    def course(self) -> CourseRef:
        return self.catalog.ref

    def exercise(self, wanted: str | None) -> Exercise:
        """The exercise a command is about: the one named, the one the folder is of, or the last worked on.

        Raises:
            NotFoundError: there is no such exercise, or none was started, or several and nothing tells which.
        """
        if wanted is not None:
            # Completion of a folder name leaves a separator at its end.
            chosen = self.catalog.exercise_called(wanted.rstrip("/\\"))
            # Of a number that meant another exercise before 2.0, one that was begun here then: name both.
            before = next((one for one in self.catalog.exercises() if str(one.number) == wanted), chosen)
            begun: tuple[Event, ...] = ()
            with suppress(CourseError):  # a damaged record is another command's to tell
                begun = self.workspace.store.events("start", before.id) if before is not chosen else ()
            if any(str(event.data.get("version")).startswith("1.") for event in begun):
                current().warn(
                    f"{wanted} is {chosen.id}, by the order of the lessons; before 2.0 it was {before.id}, "
                    f"which is {self.catalog.place_of(before)} now."
                )
            return chosen
        there = self.workspace.begun()
        names = [name for name in self.known if name in there]
        for name in (self._folder_name(), self._last_worked_on(), names[0] if len(names) == 1 else ""):
            if name in self.known:
                return self.known[name]
        if not names:
            raise self.nothing_started()
        problem = f"There are several exercises here, and none was worked on last: {', '.join(names)}."
        fix = f"Name one, as in `course check {names[0]}`, or change into its folder."
        raise NotFoundError(problem, help=fix, code="several_started")

    def of_folder(self) -> Exercise | None:
        """The exercise or warm-up that the current folder is of."""
        return self.known.get(self._folder_name())

    @cached_property
    def known(self) -> dict[str, Exercise]:
        """The exercises by their ids, in the order they are done, and then the warm-ups."""
        return {one.id: one for one in (*self.catalog.exercises(), *self.catalog.warm_ups())}

    def nothing_started(self) -> NotFoundError:
        """The error that no exercise has been started; its advice names the first one."""
        first = next(iter(self.catalog.exercises()), None)  # in the order they are done
        problem = "No exercise has been started here."
        fix = f"Start one: `course start {first.id}`." if first else "This course has no exercises."
        return NotFoundError(problem, help=fix, code="nothing_started")

    def started(self) -> tuple[Exercise, ...]:
        """The exercises and warm-ups that have been started, in the order of ``known``."""
        names = self.workspace.started()
        return tuple(one for name, one in self.known.items() if name in names)

    def unread(self, exercise: Exercise) -> str:
        """A file that is not read because of its name though it holds work; "" if there is none.

        The module with other capitals; the notebook under any other name, edited last of all that hold work;
        or either in a folder of another name.
        """
        from course.notebooks.merge import worked_in

        own = self.workspace.path(exercise.place, exercise.module)
        if not own.parent.exists():
            return self._moved(exercise)
        notebook = own.with_suffix(".ipynb")
        with suppress(OSError):
            others = [path for path in sorted(own.parent.iterdir()) if path not in (own, notebook)]
            alike = [path for path in others if path.name.lower() == own.name.lower()]
            # Where capitals do not count, as on Windows and macOS, it is the student's file itself.
            if found := next((path.name for path in alike if not (own.exists() and path.samefile(own))), ""):
                return found
            edited: dict[bytes, tuple[float, str]] = {}  # by content: an exact copy is nothing to speak of
            copies = [path for path in others if path.suffix == notebook.suffix]
            for path in filter(Path.is_file, (*copies, notebook, own) if copies else ()):
                data = path.read_bytes()
                own_work = path == own and not same_text(self.stub(exercise), data)
                if own_work or worked_in(data, exercise.id):
                    edited[data] = path.stat().st_mtime, path.name
            last = max(edited.values(), default=(0.0, own.name))[1]
            return "" if last in (own.name, notebook.name) else last
        return ""

    def _moved(self, exercise: Exercise) -> str:
        """The exercise's file, or its notebook, in a folder of another name; "" if there is none."""
        names = exercise.module, Path(exercise.module).with_suffix(".ipynb").name
        with suppress(OSError):
            folders = [path for path in sorted(self.workspace.root.iterdir()) if path.is_dir()]
            found = (path / name for path in folders for name in names if (path / name).is_file())
            return next((f"{path.parent.name}/{path.name}" for path in found), "")
        return ""

    def source(self, exercise: Exercise) -> bytes:
        """The student's file.

        Raises:
            UngradableError: there is none, or it cannot be read, or it is too large.
        """
        path = self.workspace.path(exercise.place, exercise.module)
        shown = self.workspace.shown(path)
        try:
            if not path.exists():
                raise self._missing(exercise, path, shown)
            if not path.is_file():
                raise UngradableError(f"{shown} is not a file.", help="Move it away.", code="no_file")
            must_fit(path.stat().st_size, f"{shown} is")
            return read_bytes(path)
        except OSError as error:
            problem = f"{shown} cannot be read ({error.strerror or error})."
            raise UngradableError(problem, help="Check its permissions.", code="unreadable") from error

    def _missing(self, exercise: Exercise, path: Path, shown: str) -> UngradableError:
        if path.is_symlink():
            said = f"{shown} is a link to {path.readlink()}, and no file is there."
            return UngradableError(said, help="Remove the link, or put the file back.", code="no_file")
        given = {one.name for one in exercise.given}
        beside = [one.name for one in sorted(path.parent.glob("*.py")) if one.name not in given]
        other = self.unread(exercise) or (beside[0] if len(beside) == 1 else "")
        right = Path(exercise.module).with_suffix(Path(other).suffix).name
        if "/" in other:
            advice = f"There is {other}. The folder must be called {exercise.place}: rename it back."
        elif other.lower() == right.lower():
            advice = f"Rename {other} to {right}: capitals count."
        elif other:
            advice = f"There is {other} beside it: if that is yours, rename it to {right}."
        else:
            advice = f"`course start {exercise.id}` puts one there."
        return UngradableError(f"There is no file {shown}.", help=advice, code="no_file")

    def stub(self, exercise: Exercise) -> bytes:
        """The module as it was handed out here, or else as it would be handed out now."""
        given = self.workspace.given(exercise.place, exercise.module)
        return exercise.stub_path.read_bytes() if given is None else given

    def history(self, exercise: Exercise) -> History:
        return history_of(self.workspace.store.events(subject=exercise.id))

    def known_history(self, exercise: Exercise) -> History:
        """As far as it can be read; a record that cannot be read is warned about elsewhere."""
        with suppress(CourseError):
            return self.history(exercise)
        return history_of(())

    def standing(self) -> Standing:
        """How far the student is with everything, as it is now; raises what ``history`` raises."""
        return Standing(self.workspace, self.catalog.syllabus.split)

    def record(self, kind: str, subject: str, data: dict[str, object]) -> bool:
        """Note an event; where that fails, give False, and the command goes on and says so."""
        recorder = Recorder(self.workspace.store)
        recorder(kind, subject, data)
        if recorder.trouble and recorder.trouble not in self.warnings:
            self.warnings.append(recorder.trouble)
        return recorder.kept

    def tell(self) -> None:
        """Say what was not recorded, each sentence once."""
        for warning in dict.fromkeys(self.warnings):
            if warning not in self._told:
                current().warn(warning)
        self._told.update(self.warnings)

    def answer(self, reply: Envelope) -> int:
        """End a command: say what was not recorded, print the object of ``--json``, give the exit code."""
        self.tell()
        return current().answer(reply)

    def _folder_name(self) -> str:
        """The first folder below the workspace on the way to the current one; "" if there is none."""
        if not cwd().is_relative_to(self.workspace.root):
            return ""
        parts = cwd().relative_to(self.workspace.root).parts
        return next(iter(parts[1:] if parts[:1] == (WARM_UPS,) else parts), "")

    def _last_worked_on(self) -> str:
        """The exercise last started, checked by name or asked a hint for; "" if there is none."""
        kinds = {"start", "check", "hint"}
        with suppress(CourseError):
            events = reversed(self.workspace.store.events())
            return next((e.subject for e in events if e.kind in kinds and not e.data.get("all")), "")
        return ""


def cwd() -> Path:
    try:
        return Path.cwd()
    except OSError:
        problem = "The current folder no longer exists."
        raise NotFoundError(problem, help="Change to another one.", code="directory_not_found") from None


def named(path: Path | str) -> Path:
    """A path that the user named, from the current folder; ``~`` is a home folder.

    Raises:
        UsageError: nothing can be there: a home of nobody, a name that is too long, a link to itself.
    """
    try:
        full = cwd() / Path(path).expanduser()
        with suppress(FileNotFoundError, NotADirectoryError, PermissionError):
            full.stat()
    except (RuntimeError, OSError) as error:
        why = getattr(error, "strerror", None) or f"there is no home folder {Path(path).parts[0]}"
        problem = f"{path} cannot be used: {why}."
        raise UsageError(problem, help="Name another file or folder.", code="bad_file_name") from None
    return full


def load_catalog() -> Catalog:
    from course.catalog.load import Catalog

    return Catalog()


def catalog_of(workspace: Workspace) -> Catalog:
    """The course in use; raises MissingCapabilityError if the workspace is another course's."""
    catalog = load_catalog()
    if workspace.course_id != catalog.course_id:
        raise MissingCapabilityError(
            f"{workspace.root} is a workspace of the course {workspace.course_id!r}; "
            f"this is {catalog.course_id!r}.",
            help="Work in a workspace of this course, or install the other one.",
            code="other_course",
        )
    return catalog


def find_workspace() -> Here | None:
    """The workspace of the current folder, or None outside of one."""
    with suppress(NotFoundError):
        return Here.load()
    return None


def here_or_outside() -> tuple[Here | None, Catalog]:
    """The workspace of the current folder, or None outside of one; and the course in use."""
    here = find_workspace()
    return here, here.catalog if here is not None else load_catalog()


# ---
# Files that commands write to a given place. A copy of what was there before is kept and reported.


#: The formats of a figure, by the suffix of its name.
FORMATS = ("png", "svg", "pdf")


def target(path: Path, option: str, endings: tuple[str, ...]) -> Path:
    """Where to write, checked before anything is computed.

    Raises:
        UsageError: the name ends in something else, or there is no such folder.
    """
    full = named(path)
    if full.suffix.lower().removeprefix(".") not in endings:
        wrong = f"the name must end in {' or '.join(f'.{ending}' for ending in endings)}"
        advice = f"For example {option} {path.stem or 'run'}.{endings[0]}."
    elif full.is_dir():
        wrong, advice = "this is a folder", "Name a file."
    elif not full.parent.is_dir():
        wrong, advice = f"there is no folder {full.parent}", "Make it, or name another file."
    else:
        return full
    raise UsageError(f"{option} {path}: {wrong}.", help=advice, code="bad_file_name")


def inserted(path: Path, name: str) -> Path:
    """One of several files: run.png becomes run-free-fall.png."""
    return path.with_name(f"{path.stem}-{name}{path.suffix}")


def as_csv(names: Iterable[str], rows: Iterable[Iterable[object]]) -> bytes:
    """A table as CSV: a line of names, then every row, each number with every digit."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(names)
    writer.writerows(rows)
    return text.getvalue().encode()


def write_told(path: Path, data: bytes, *, why: str) -> WrittenFile:
    """As ``write``, and say where the file is, and the copy."""
    file = write(path, data, why=why)
    if file.backup:
        current().line(f"There was another {file.path}; it is kept at {file.backup.backup}.")
    current().line(f"Wrote {file.path}")
    return file


def write(path: Path, data: bytes, *, why: str) -> WrittenFile:
    """Write a file; if there is another one of that name, keep a copy of it first.

    Inside a workspace copies go where all its backups are, elsewhere beside the file.

    Raises:
        UsageError: the file cannot be written.
        MissingCapabilityError: the copy cannot be written; the file is then unchanged.
    """
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
    try:
        return Workspace.find(path.parent).backup(path, why)
    except CourseError as error:
        if error.code != "workspace_not_found":
            raise
    for number in itertools.count(1):
        copy = path.with_name(f"{path.stem}.old-{number}{path.suffix}")
        try:
            with suppress(FileExistsError), copy.open("xb") as file:
                file.write(old)
                break
        except OSError as error:
            problem = f"{path} is there, and no copy of it can be kept ({error.strerror or error})."
            raise UsageError(problem, help="Name another file.", code="not_writable") from error
    return copy
