"""A class folder, read as data: whose submission for which exercise, or why there is none.

    <student>/<module>.py
    <student>/<exercise-id>/<module>.py
    <student>/<anything>.zip        as ``course submit`` writes it

or ``<module>.ipynb`` in place of ``<module>.py``: the module that a notebook stands for is graded.

``course.grading.intake.downloads`` says who the students are and where their files lie. Only files an
exercise declares are read; nothing here executes, unpacks to disk or follows anything. What has to be parsed
for that, notebooks and archives, is read by a process of its own (``reading``).
"""

from __future__ import annotations

import contextlib
import hashlib
import os
import stat
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from course.errors import UngradableError
from course.grading.gradebook.book import SubmittedAt
from course.grading.intake.archives import MAX_FILE, RefusedError
from course.grading.intake.downloads import Place, Student, class_list
from course.grading.intake.reading import reader
from course.handed_in.cells import MAX_NOTEBOOK
from course.handed_in.notebook import RECORD
from course.scoring.session import Submission
from course.scoring.verdict import Problem

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from course.catalog.models import Exercise

__all__ = ["MAX_FILE", "Entry", "read_class", "read_quiz", "read_student", "witnesses"]


@dataclass(frozen=True)
class Entry:
    """One student and one exercise.

    Attributes:
        student: the student's id.
        submission: what is to be graded; None if there is nothing.
        problem: why there is nothing; None together with ``submission`` None means it was not handed in.
        times: who says when it was handed in.
    """

    student: str
    exercise: Exercise
    submission: Submission | None = None
    problem: Problem | None = None
    times: tuple[SubmittedAt, ...] = field(default=(), compare=False)

    @property
    def sha256(self) -> str:
        """Digest of the submission; of nothing where there is none."""
        return self.submission.sha256 if self.submission else hashlib.sha256().hexdigest()


def read_class(folder: Path, exercises: Sequence[Exercise], *, required: bool) -> Iterator[Entry]:
    """Every student's entries, students in order of name.

    Args:
        required: whether an exercise without a file is ungradable (it was asked for by name) or merely
            not submitted.

    Raises:
        NotFoundError: there is no such folder.
    """
    for student in class_list(folder).students:
        yield from read_student(student, exercises, required=required)


def read_student(student: Student, exercises: Sequence[Exercise], *, required: bool) -> Iterator[Entry]:
    """The entries of one student, one per exercise."""
    name, place = student.name, student.place
    try:
        if place.files is None and place.root.is_symlink():
            raise RefusedError("symlink", "The student's folder is a link.", "Hand in the folder itself.")
        archives = place.archives()
    except RefusedError as refused:
        for exercise in exercises:
            yield Entry(name, exercise, problem=refused.problem)
        return
    except OSError as error:
        message = f"The student's folder cannot be read: {error.strerror}."
        for exercise in exercises:
            yield Entry(name, exercise, problem=Problem("unreadable", message, _PERMISSIONS))
        return
    for exercise in exercises:
        try:
            found = _find(place, archives, exercise)
        except RefusedError as refused:
            yield Entry(name, exercise, problem=refused.problem)
        else:
            if found is not None:
                submission, path = found
                times = witnesses(student, exercise.id, submission.sha256, path)
                yield Entry(name, exercise, submission, times=times)
            else:
                yield Entry(name, exercise, problem=_no_file(exercise) if required else None)


def witnesses(student: Student, exercise: str, sha256: str, path: Path | None) -> tuple[SubmittedAt, ...]:
    """Who says when a submission was handed in: the platform it came from, and the time of its file.

    Nothing inside a submission is asked: a student's machine wrote it.
    """
    said: list[tuple[str, float | None]] = []
    if student.submitted_at is not None and student.identity is not None:
        said.append((student.identity.source, student.submitted_at))
    if student.flagged_late:
        said.append(("canvas-late", None))
    if path is not None:
        with contextlib.suppress(OSError):
            said.append(("mtime", path.lstat().st_mtime))
    return tuple(SubmittedAt(student.name, exercise, sha256, source, at) for source, at in said)


_PERMISSIONS = "Check the permissions of the file and of the folders above it."


def _no_file(exercise: Exercise) -> Problem:
    return Problem(
        "no_file",
        f"There is no {exercise.module} for {exercise.id}.",
        f"Put it at {exercise.module} or {exercise.id}/{exercise.module} in the student's folder, or hand in "
        "the zip that `course submit` writes.",
    )


def _find(place: Place, archives: list[Path], exercise: Exercise) -> tuple[Submission, Path] | None:
    """The one candidate for an exercise and the file it came in, None if there is none.

    Raises:
        RefusedError: there are several, or the one cannot be read.
    """
    plain = place.find(exercise.module, f"{exercise.id}/{exercise.module}")
    notebook = Path(exercise.module).with_suffix(".ipynb").name
    notebooks = place.find(notebook, f"{exercise.id}/{notebook}")
    packed: list[tuple[Path, str, bytes]] = []
    for archive in archives:
        held = reader.module_in(archive, exercise)
        if held is not None:
            packed.append((archive, *held))
    files = [*plain, *notebooks]
    candidates = [*files, *(archive for archive, *_ in packed)]
    if len(candidates) > 1:
        names = ", ".join(place.shown(path) for path in candidates)
        message = f"There are several files for {exercise.id}: {names}."
        raise RefusedError("ambiguous_files", message, "Keep the one that counts.")
    if files:
        path = files[0]
        for part in path.relative_to(place.root).parents:
            if part.name and (place.root / part).is_symlink():
                raise RefusedError("symlink", f"{part} is a link.", "Hand in the folder itself.")
        limit = MAX_NOTEBOOK if notebooks else MAX_FILE
        return _submission(exercise, path.name, _read_regular(path, place.shown(path), limit)), path
    return (_submission(exercise, *packed[0][1:]), packed[0][0]) if packed else None


def _submission(exercise: Exercise, name: str, content: bytes) -> Submission:
    """A file as a submission; a notebook becomes the module that it stands for.

    Raises:
        RefusedError: it is empty, or a notebook that cannot be graded.
    """
    shown = name.rpartition("/")[2]
    if not content.strip():
        raise RefusedError("empty_file", f"{shown} is empty.", "Was it saved before it was handed in?")
    if not name.endswith(".ipynb"):
        return Submission({exercise.module: content})
    source, record = reader.notebook(content, exercise, shown)
    if len(source) > MAX_FILE:
        message = f"The functions of {shown} are larger than 1 MB."
        raise RefusedError("too_large", message, "Hand in source code only.")
    return Submission({exercise.module: source, RECORD: record})


def _read_regular(path: Path, shown: str, limit: int) -> bytes:
    """The content of a regular file within the limit; opening neither follows a link nor waits for a pipe."""
    try:
        status = path.lstat()
        if stat.S_ISLNK(status.st_mode):
            raise RefusedError("symlink", f"{shown} is a link.", "Hand in the file itself.")
        if not stat.S_ISREG(status.st_mode):
            raise RefusedError("not_a_file", f"{shown} is not a regular file.", "Hand in the file itself.")
        flags = os.O_RDONLY | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_NONBLOCK", 0)
        with open(os.open(path, flags | getattr(os, "O_BINARY", 0)), "rb") as handle:  # noqa: PTH123
            content = handle.read(limit + 1)
    except OSError as error:
        message = f"{shown} cannot be read: {error.strerror or error}."
        raise RefusedError("unreadable", message, _PERMISSIONS) from None
    if len(content) > limit:
        advice = "Hand in source code only, and a notebook without its outputs."
        raise RefusedError("too_large", f"{shown} is larger than {limit >> 20} MB.", advice)
    return content


def read_quiz(student: Student) -> tuple[Any, Path | None]:
    """The quiz attempts of a student, as JSON gave them, and the archive they came in; an empty list if none.

    An archive that cannot be read gives none: the exercises in it report what is wrong with it.

    Raises:
        UngradableError: several archives hold attempts.
    """
    found: list[tuple[Any, Path]] = []
    place = student.place
    with contextlib.suppress(OSError):
        if place.files is None and place.root.is_symlink():
            return [], None
        for path in place.archives():
            with contextlib.suppress(RefusedError):
                record = reader.quiz_in(path)
                found += [(record, path)] if record else []
    if len(found) > 1:
        raise UngradableError(
            "Several archives hold quiz attempts.", help="Keep the one that counts.", code="ambiguous_files"
        )
    return found[0] if found else ([], None)
