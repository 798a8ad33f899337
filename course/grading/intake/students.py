"""A class folder, read as data: which student handed in which exercise, or why there is nothing to grade.

    <student>/<module>.py
    <student>/<exercise-id>/<module>.py
    <student>/<anything>.zip        as ``course submit`` writes it

or ``<module>.ipynb`` in place of ``<module>.py``: the module that the notebook makes up is graded. Accepted
spellings of these names are in ``downloads``. Files that are left over, with another name, in another folder,
or beside the one that was graded, are always reported, with the exercises whose functions they have. An
instructor decides on the proposals with ``course grade assign``.

``course.grading.intake.downloads`` says who the students are and where their files lie. Only files that an
exercise declares are read; nothing here executes a file, unpacks one to disk or follows a link. Notebooks and
archives have to be parsed for that, which a separate process does (``archives``).
"""

from __future__ import annotations

import contextlib
import difflib
import hashlib
import os
import re
import stat
from collections.abc import Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import msgspec

from course.catalog.models import Exercise
from course.errors import InternalError, UngradableError
from course.grading.gradebook.records import ELSEWHERE, SubmittedAt
from course.grading.intake.archives import RefusedError, reader
from course.grading.intake.downloads import (
    IS_CODE,
    Place,
    Student,
    is_clutter,
    is_meant,
    is_notebook,
    kind_of,
    lies_aside,
    may_be_code,
    plain,
)
from course.handed_in.limits import HANDED_IN, MANIFEST, MAX_FILE, MAX_NOTEBOOK
from course.handed_in.notebook import RECORD
from course.printable import one_line, quoted, some
from course.scoring.judging.submission import Submission
from course.scoring.verdict import Problem, Verdict
from course.strangers import in_utf8, marked_encoding


@dataclass(frozen=True)
class Entry:
    """One student and one exercise.

    Attributes:
        submission: to grade; None if there is nothing.
        problem: why there is nothing; if both are None, the exercise was not handed in.
        unread: it was not asked for, and there is work for it.
        times: of the submission, each with its source.
        notes: assumptions that were made, and files that were left aside, one sentence each.
        written: the Python and NumPy that it was written with, by its own account; empty if unknown.
        found: files that may be meant for the exercise, where there is a problem.
        only: ids of the checks to run; empty runs all.
        asks: which functions each check used is asked for, too.
    """

    student: str
    exercise: Exercise
    submission: Submission | None = None
    problem: Problem | None = None
    unread: bool = field(default=False, compare=False)
    times: tuple[SubmittedAt, ...] = field(default=(), compare=False)
    notes: tuple[str, ...] = field(default=(), compare=False)
    written: str = field(default="", compare=False)
    found: Found | None = field(default=None, compare=False)
    only: tuple[str, ...] = ()
    asks: bool = False

    def told(self, verdict: Verdict) -> Verdict:
        """A verdict on it with what there is to say of the file, and with its versions where they matter."""
        notes = self.notes
        said = [*verdict.warnings, *(f"{check.message} {check.help}" for check in verdict.checks)]
        said += [verdict.error.help] if verdict.error else []
        if self.written and any("checked with" in one for one in said):
            notes = (*notes, f"It was written with {self.written}.")
        return msgspec.structs.replace(verdict, warnings=(*verdict.warnings, *notes))

    @property
    def sha256(self) -> str:
        """Digest of the submission; of empty content where there is none."""
        return self.submission.sha256 if self.submission else hashlib.sha256().hexdigest()


def read_student(
    student: Student,
    exercises: Sequence[Exercise],
    *,
    required: bool,
    others: Sequence[Exercise] | None = None,
) -> list[Entry]:
    """The entries of one student, one per exercise; a failure here does not affect other students.

    Args:
        required: whether an exercise without a file is ungradable (it was asked for by name) or merely not
            submitted.
        others: the course's other exercises. Where all that is there is known to be for these, an exercise
            that is required is merely not submitted, too; and each with work has an entry that says so.
    """
    reader.turn_to(student)
    try:
        return list(_entries(student, exercises, required=required, others=others))
    except InternalError:
        raise
    except Exception as error:  # noqa: BLE001 - an unforeseen fault is named; the class goes on
        problem = _unforeseen(error)
        return [Entry(student.name, exercise, problem=problem) for exercise in exercises]


def _unforeseen(error: Exception) -> Problem:
    # Students read this too: of the system's errors only the reason, which has no path in it.
    reason = (error.strerror if isinstance(error, OSError) else str(error)) or "no reason was given"
    message = f"It cannot be read: {type(error).__name__}, {one_line(reason, 200)}."
    return Problem("unreadable", message, "Look at it; `course grade assign` takes any file by its path.")


def _entries(
    student: Student, exercises: Sequence[Exercise], *, required: bool, others: Sequence[Exercise] | None
) -> Iterator[Entry]:
    name, place = student.name, student.place
    every = (*exercises, *(others or ()))
    if student.several:
        yield from _unclear(student, exercises, every, required=required)
        return
    try:
        if place.files is None and place.root.is_symlink():
            raise RefusedError("symlink", "The student's folder is a link.", "Hand in the folder itself.")
        place = place.unwrapped({exercise.place for exercise in every})
        above = quoted(str(place.root.relative_to(student.place.root)))
        around = [f"Everything lies in the folder {above}, which was passed over."]
        around = around if place is not student.place else []
        archives = place.archives()
    except (RefusedError, OSError) as error:
        if isinstance(error, RefusedError):
            problem = error.problem
        else:
            message = f"The student's folder cannot be read: {error.strerror}."
            problem = Problem("unreadable", message, _PERMISSIONS)
        yield from (Entry(name, exercise, problem=problem) for exercise in exercises)
        return
    taken = [(exercise, _found(place, archives, exercise)) for exercise in exercises]
    used = {at for _, item in taken if isinstance(item, _FoundWork) for at in item.used}
    left = survey(place, used, every)
    mine = _meant(left, every) if others is not None else dict.fromkeys((one.id for one in every), left)
    alone = not used and any("archive" in one.kind for one in left)
    busy = others is not None and bool(used or left or archives or place.find(MANIFEST, "."))
    for exercise, item in taken:
        there = mine[exercise.id]
        tidy = others is not None and bool(used or len(there) < len(left))
        refused = _stub_beside(exercise, item, there) if isinstance(item, _FoundWork) else item
        if isinstance(item, _FoundWork) and refused is None:
            times = witnesses(student, exercise.id, item.submission.sha256, item.path)
            notes = (*around, *item.notes, *_beside(exercise, item, there))
            yield Entry(name, exercise, item.submission, times=times, notes=notes, written=item.written)
            continue
        tidy = tidy or isinstance(item, _FoundWork)
        yield _without(
            student, exercise, refused, there, required=required, busy=busy, tidy=tidy, alone=alone
        )
    for exercise in others or ():
        if found_for(exercise, mine[exercise.id], asked=()):
            yield Entry(name, exercise, unread=True)


def _unclear(
    student: Student, exercises: Sequence[Exercise], every: Sequence[Exercise], *, required: bool
) -> Iterator[Entry]:
    """The entries of a student with several places, of which an instructor has to say which counts."""
    named = [
        msgspec.structs.replace(one, name=f"{one_line(name)}/{one.name}")
        for name, place in student.several
        if place.files is not None or not place.root.is_symlink()
        for one in survey(place, set(), every)
    ]
    mine = _meant(named, every)
    problem = Problem("ambiguous_files", f"{student.unclear}.", "The instructor chooses the one that counts.")
    for exercise in every:
        found = found_for(exercise, mine[exercise.id], asked=())
        if exercise not in exercises:
            if found:
                yield Entry(student.name, exercise, unread=True)
        elif found or (required and not any(mine.values())):
            files = tuple(msgspec.structs.replace(one, proposed=False) for one in found)
            listed = Found(problem.code, files) if files else None
            yield Entry(student.name, exercise, problem=problem, found=listed)
        else:
            yield Entry(student.name, exercise)


def _found(place: Place, archives: list[Path], exercise: Exercise) -> _FoundWork | RefusedError | None:
    try:
        return _find(place, archives, exercise)
    except RefusedError as refused:
        return refused
    except (OSError, ValueError) as error:
        problem = _unforeseen(error)
        return RefusedError(problem.code, problem.message, problem.help)


def _meant(left: list[Candidate], every: Sequence[Exercise]) -> dict[str, list[Candidate]]:
    """The files that may be meant for each exercise, so not those of another one.

    A file is another's by its functions, if it has none of this one, or by its name, if the other has all of
    those that it shares with this one.
    """
    meant: dict[str, list[Candidate]] = {exercise.id: [] for exercise in every}
    for one in left:
        name = Path(one.name).name
        has = {item.id: {task.id for task in item.task}.intersection(one.defines) for item in every}
        names = {item.id: (item.module, str(Path(item.module).with_suffix(".ipynb"))) for item in every}
        called = {id_ for id_, wanted in names.items() if any(is_meant(name, one) for one in wanted)}
        for id_, mine in has.items():
            others = [(other in called, theirs) for other, theirs in has.items() if other != id_]
            if not any((theirs and not mine) or (by_name and theirs >= mine) for by_name, theirs in others):
                meant[id_].append(one)
    return meant


def _beside(exercise: Exercise, taken: _FoundWork, left: list[Candidate]) -> list[str]:
    """Other files with functions of the same exercise, and those that are written in no other; always
    reported."""
    found = found_for(exercise, left, asked=())
    others = [one for one in found if one.defines and one.sha256 not in taken.contents]
    if not others:
        return []
    notes = [f"Also there, and not graded: {described(others)}."]
    source = taken.submission.files[exercise.module]
    _, written = _outline(exercise, taken)
    for one in others:
        # What a line gives its name, as a lambda, counts as written.
        only = [
            name
            for name in one.written
            if name not in written and not re.search(rf"(?m)^\s*{name}\s*[:=]".encode(), source)
        ]
        if only:
            return [*notes, f"{ELSEWHERE}{', '.join(only)} in {quoted(one.name)}."]
    return notes


def _outline(exercise: Exercise, taken: _FoundWork) -> tuple[Collection[str], Collection[str]]:
    """The exercise's functions that the graded file defines, and those of them that are written."""
    path, member = taken.used[0]
    tasks = tuple(task.id for task in exercise.task)
    outlines = reader.outlines(Path(path), (), tasks)
    return next(
        ((defines, written) for name, _, defines, written, *_ in outlines if name == member), ((), ())
    )


#: How notes begin, or end, that say which of a student's files was graded, and how it was found.
_ABOUT_A_FILE = re.compile(
    rf"(Graded from|Also there, and not graded:|{ELSEWHERE}|These are the same file:|The same file is in"
    r"|The folder |Everything (in|lies in) |It was written with ).*"
    r"|.*( was taken for | was read as one\.|taken for folders\.).*",
    re.DOTALL,
)


def about_a_file(note: str) -> bool:
    """Whether a note of a verdict is one of those that reading a student's files made, or an assignment."""
    return _ABOUT_A_FILE.fullmatch(note) is not None


def _stub_beside(exercise: Exercise, taken: _FoundWork, left: list[Candidate]) -> RefusedError | None:
    """Where nothing is written in the file with the right name, and something is in another, the question."""
    others = [one for one in found_for(exercise, left, asked=()) if one.written]
    if not others:
        return None
    defines, written = _outline(exercise, taken)
    if written or not defines:
        return None
    message = f"Nothing is written in the file for {exercise.id}. There is {described(others)}."
    return RefusedError("ambiguous_files", message, "Keep the one that counts.")


def _without(
    student: Student,
    exercise: Exercise,
    refused: RefusedError | None,
    left: list[Candidate],
    *,
    required: bool,
    busy: bool,
    tidy: bool,
    alone: bool,
) -> Entry:
    """The entry for an exercise without a usable file, with the files that may be meant.

    Args:
        busy: the student handed in something, so that only what may be meant is a problem.
        tidy: some of it has its right name, so that only other code and archives may be meant.
        alone: nothing of the student's was taken, and there is an archive, which may hold anything.
    """
    problem = refused.problem if refused else None
    found: tuple[Candidate, ...] = ()
    if problem is None or problem.code in _FOR_TRIAGE:
        code = [one for one in left if may_be_code(one.name) or "archive" in one.kind]
        any_file = code if tidy and problem is None else left
        found = found_for(exercise, left, asked=any_file if required or problem or alone else ())
    if problem is None and (found or (required and (student.typed or not busy))):
        problem = _no_file(exercise, found, student.typed)
    if problem is None or not found:
        return Entry(student.name, exercise, problem=problem)
    times = tuple((time.source, time.at) for time in witnesses(student, exercise.id, "", None))
    return Entry(student.name, exercise, problem=problem, found=Found(problem.code, found, times))


def witnesses(student: Student, exercise: str, sha256: str, path: Path | None) -> tuple[SubmittedAt, ...]:
    """The times of a submission: the platform's, and its file's.

    Nothing inside a submission counts, because a student's machine wrote it.
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
#: Problems that a file under another name, in another encoding, or a choice between files, would solve.
_FOR_TRIAGE = {"no_file", "ambiguous_files", "refused_archive", "syntax_error"}


def _no_file(exercise: Exercise, found: tuple[Candidate, ...], typed: tuple[str, ...]) -> Problem:
    message = f"There is no {exercise.module} for {exercise.id}."
    if found:
        message += f" There is {described(found)}."
    if typed:
        message += f" The text typed into the platform is not a file: {some([*map(quoted, typed)], _SHOWN)}."
    names = f"{exercise.module} or {exercise.id}/{exercise.module}"
    advice = f"It is to be handed in as {names}, or as the zip that `course submit` writes."
    return Problem("no_file", message, advice)


@dataclass(frozen=True)
class _FoundWork:
    """The file that was found for an exercise by its name: where it came in, all paths, and members of
    archives, that hold it, and the digests of the files, unchanged."""

    submission: Submission
    path: Path
    used: tuple[tuple[str, str], ...]
    contents: frozenset[str]
    notes: tuple[str, ...] = ()
    written: str = ""


def _find(place: Place, archives: list[Path], exercise: Exercise) -> _FoundWork | None:
    """The one candidate for an exercise, None if there is none; copies of one file count as one."""
    notebook = Path(exercise.module).with_suffix(".ipynb").name
    plain = place.find(exercise.module, exercise.place)
    notebooks = place.find(notebook, exercise.place)
    opened = [(archive, reader.module_in(archive, exercise)) for archive in archives]
    packed = [(archive, held) for archive, held in opened if held is not None]
    files = [*plain, *notebooks]
    candidates = [*files, *(archive for archive, _ in packed)]
    if not candidates:
        return None
    names = some([place.shown(path) for path in candidates], _SHOWN)
    message = f"There are several files for {exercise.id}: {names}."
    several = RefusedError("ambiguous_files", message, "Keep the one that counts.")
    try:
        contents = [_content(place, path, exercise, notebook=path in notebooks) for path in files]
    except RefusedError as refused:
        raise (several if len(candidates) > 1 else refused) from None
    contents += [held.content for _, held in packed]
    if len(set(contents)) > 1:
        raise several
    used = [(str(path), "") for path in files]
    used += [(str(path), member) for path, held in packed for member in held.copies]
    notes = [note for _, held in packed[: 1 if not files else 0] for note in held.notes]
    path = candidates[0]
    notes += _unlike_its_name(path) if files else []
    called = path.name if files else packed[0][1].name
    if files and (given := place.given(path)) not in {exercise.module, notebook}:
        notes.append(f"{quoted(given)} was taken for {exercise.module}.")
    above = path.parent.name if place.files is None and path.parent != place.root and files else ""
    if above and above != exercise.place.rpartition("/")[2]:
        notes.append(f"The folder {quoted(above)} was taken for {exercise.place}.")
    if len(candidates) > 1:
        notes.append(f"These are the same file: {names}.")
    digests = frozenset({hashlib.sha256(contents[0]).hexdigest()})
    submission = _submission(exercise, called, contents[0])
    written = next((held.written for _, held in packed), "")
    if RECORD in submission.files:
        written = _kernel(contents[0]) or written
    return _FoundWork(submission, path, tuple(used), digests, tuple(notes), written)


def _kernel(notebook: bytes) -> str:
    """The Python that a notebook ran in last, by its own account; "" if it says nothing."""
    at = notebook.rfind(b'"language_info"')
    found = re.search(rb'"version"\s*:\s*"(\d[\w.+-]{0,40})"', notebook[at : at + 2000]) if at >= 0 else None
    return f"Python {found[1].decode()}" if found else ""


def _content(place: Place, path: Path, exercise: Exercise, *, notebook: bool) -> bytes:
    """What a file holds for an exercise; one that is a zip by its content is read as such."""
    for part in path.relative_to(place.root).parents:
        if part.name and (place.root / part).is_symlink():
            raise RefusedError("symlink", f"{quoted(str(part))} is a link.", "Hand in the folder itself.")
    shown = place.shown(path)
    content = _read_regular(path, shown, MAX_NOTEBOOK)
    kind = kind_of(path.name, content)
    if kind == "a zip archive":
        held = reader.module_in(path, exercise)
        if held is None:
            message = f"{shown} is a zip archive without a file for {exercise.id}."
            raise RefusedError("refused_archive", message, "Hand in the file itself.")
        return held.content
    if kind in {"", "a notebook", "an empty file", "no text"}:
        return _within(content, shown, MAX_NOTEBOOK if notebook or kind == "a notebook" else MAX_FILE)
    message = f"{shown} is {kind}, whatever its name says."
    raise RefusedError("no_code", message, "Hand in the .py file itself.")


def _unlike_its_name(path: Path) -> list[str]:
    """That a file that was taken is another kind of file than its name says."""
    with path.open("rb") as handle:
        kind = kind_of(path.name, handle.read(1 << 16))
    return [f"{quoted(path.name)} is {kind}, and was read as one."] if kind in _TAKEN_AS else []


_TAKEN_AS = frozenset({"a notebook", "a zip archive"})


def submission_from(exercise: Exercise, path: Path, member: str = "") -> Submission:
    """A file that an instructor named as a submission, whatever its name.

    Args:
        member: name in the archive at ``path``; empty for the file itself.
    """
    content = reader.member(path, member) if member else _read_regular(path, quoted(path.name), MAX_NOTEBOOK)
    notebook = (member or path.name).casefold().endswith(".ipynb") or is_notebook(content)
    _within(content, quoted(path.name), MAX_NOTEBOOK if notebook else MAX_FILE)
    kind = kind_of(member or path.name, content)
    if not notebook and kind not in {"", "a text", "an empty file", "no text"}:
        message = f"{quoted(member or path.name)} cannot be graded: it is {kind}."
        advice = "Name a .py file or a notebook; a path into an archive has a slash."
        raise RefusedError("no_code", message, advice)
    if notebook:
        return _submission(exercise, "named.ipynb", content)
    return _submission(exercise, "named.py", in_utf8(content))


def _submission(exercise: Exercise, name: str, content: bytes) -> Submission:
    """A file as a submission; a notebook becomes the module that it makes up. It is refused if it is
    empty, in an encoding that Python does not expect, or a notebook that cannot be graded."""
    called = name.rpartition("/")[2]
    shown = quoted(called)
    if not content.strip():
        raise RefusedError("empty_file", f"{shown} is empty.", "Was it saved before it was handed in?")
    if not name.casefold().endswith(".ipynb") and not is_notebook(content):
        if in_utf8(content) != content:
            saved = marked_encoding(content) or "Windows' western code page"
            message = f"{shown} is saved in {saved} and does not say so, and Python cannot read it."
            advice = "Save it as UTF-8, or declare its encoding in the first line."
            raise RefusedError("syntax_error", message, advice)
        return Submission({exercise.module: content})
    source, record = reader.notebook(content, exercise, called)
    if len(source) > MAX_FILE:
        message = f"The functions of {shown} are larger than {MAX_FILE >> 20} MB."
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
    return _within(content, shown, limit)


def _within(content: bytes, shown: str, limit: int) -> bytes:
    if len(content) > limit:
        advice = "Hand in source code only, and a notebook without its outputs."
        raise RefusedError("too_large", f"{shown} is larger than {limit >> 20} MB.", advice)
    return content


def read_quiz(student: Student, *, alone: bool = False) -> tuple[Any, Path | None]:
    """A student's quiz attempts, as in the JSON, and the file they came in; an empty list if none.

    Of several files the one counts that has all attempts of the others, and then its own. An archive that
    cannot be read gives none: the exercises in it report what is wrong with it.

    Args:
        alone: no exercise is read that could.

    Raises:
        UngradableError: each of several files has attempts that the others lack, or a file that may hold
            some was not read.
    """
    found: list[tuple[Any, Path]] = []
    unread: RefusedError | None = None
    reader.turn_to(student)
    for one in student.places:
        with contextlib.suppress(OSError):
            if one.files is None and one.root.is_symlink():
                continue
            place = one.unwrapped(())
            for path in (*place.archives(), *place.find(MANIFEST, ".")):
                try:
                    packed = path.suffix.lower() == ".zip"
                    loose = b"" if packed else _read_regular(path, place.shown(path), MAX_FILE)
                    record = reader.quiz_in(path, loose)
                    found += [(record, path)] if record else []
                except RefusedError as refused:
                    unread = refused if alone or reader.spent else unread
    # A damaged record takes nothing from one that can be read.
    found = [one for one in found if not isinstance(one[0], str)] or found
    if unread and not found:
        raise unread
    if not found:
        return [], None
    most = max(found, key=lambda one: len(one[0]))
    if any(record != most[0][: len(record)] for record, _ in found):
        names = some([place.shown(path) for _, path in found], _SHOWN)
        message = f"Several files hold different quiz attempts: {names}."
        raise UngradableError(message, help="Keep the one that counts.", code="ambiguous_files")
    return most


#: How far one student's folder is searched: depth of folders, entries, files read, and files that killed the
#: reading process, which may have taken ten seconds each.
_DEEP, _ENTRIES, _READ, _FATAL = 6, 2000, 60, 3
#: Code of one student that is parsed, in characters; a million of the densest take about 3 s of CPU.
_CODE = 3 << 20
#: How alike two names must be, up to 1, for one to count as a misspelling of the other: ``integrator`` for
#: ``integrators`` is 0.95, ``collision`` for ``integrators`` 0.3.
_ALIKE = 0.75
_SHOWN = 4


class Candidate(msgspec.Struct, frozen=True):
    """One file that may be meant for an exercise.

    Attributes:
        name: path from the student's folder; for a file in an archive, it continues after the archive's name.
        path: of the file, or of the archive it lies in, as the system has it: not every name is text.
        member: in the archive; empty for a file.
        sha256: digest of its content.
        defines: names of the functions in it; only an exercise's tasks, where it is listed for an exercise.
        written: those of them that do more than a stub's.
        code: digest of what it defines and assigns; empty if nothing is known of it.
        kind: what it is, or why it cannot be read; empty for code and notebooks.
        proposed: it is the only match.
    """

    name: str
    path: bytes
    member: str = ""
    sha256: str = ""
    defines: tuple[str, ...] = ()
    proposed: bool = False
    kind: str = ""
    written: tuple[str, ...] = ()
    code: str = ""


class Found(msgspec.Struct, frozen=True):
    """The files of one student that may be meant for an exercise, but not by their names.

    Attributes:
        reason: the code of the problem.
        times: who says when it was handed in, and when.
    """

    reason: str
    candidates: tuple[Candidate, ...]
    times: tuple[tuple[str, float | None], ...] = ()


def survey(place: Place, used: set[tuple[str, str]], exercises: Sequence[Exercise]) -> list[Candidate]:
    """A student's files that no exercise was graded from.

    Args:
        used: path and member of the graded ones.
        exercises: look for their functions.
    """
    functions = tuple(dict.fromkeys(task.id for exercise in exercises for task in exercise.task))
    candidates: list[Candidate] = []
    left = _CODE
    # What is most likely work comes first, should there be more than is read.
    for name, path in sorted(_files(place), key=lambda item: _unlikely(item[0])):
        fatal = sum(not one.sha256 for one in candidates)
        if len(candidates) >= _READ or fatal >= _FATAL:
            break
        if (str(path), "") not in used:
            skip = tuple(member for archive, member in used if archive == str(path) and member)
            found, parsed = _outlined(name, path, skip, functions if left > 0 else ())
            candidates += found
            left -= parsed
    return candidates[:_READ]


def _unlikely(name: str) -> int:
    return 2 if lies_aside(name) else not name.casefold().endswith(HANDED_IN)


def _files(place: Place) -> list[tuple[str, Path]]:
    if place.files is not None:
        files = [(name, path) for name, path in place.files if not is_meant(name, MANIFEST)]
        return [(name, path) for name, path in files if path.is_file() and not path.is_symlink()]
    aside: list[tuple[Path, str, int]] = []
    top = place.top or place.root
    passed = len(place.root.relative_to(top).parts)
    found = list(_below(top, "", -passed, iter(range(_ENTRIES)), aside))
    left = iter(range(_ENTRIES))
    for folder, above, depth in aside:  # last, and only for what a person may have written
        there = _below(folder, above, depth, left, None)
        found += [(name, path) for name, path in there if lies_aside(name)]
    if passed:  # what lies beside the folder that was passed over is "../build/work.py"
        return [(Path(os.path.relpath(path, place.root)).as_posix(), path) for _, path in found]
    return found


def _below(
    folder: Path, above: str, depth: int, left: Iterator[int], aside: list[tuple[Path, str, int]] | None
) -> Iterator[tuple[str, Path]]:
    """Names and paths of the files in a folder, until as many entries were looked at as are left.

    Args:
        aside: takes the folders that count nowhere; None looks into them, too.
    """
    try:
        entries = sorted(os.scandir(folder), key=lambda entry: entry.name)
    except OSError:
        return  # a folder that cannot be listed was refused with its reason elsewhere
    for entry in entries:
        if next(left, None) is None:
            return
        path = folder / entry.name
        if entry.is_symlink():
            continue
        if entry.is_dir(follow_symlinks=False):
            if depth >= _DEEP or (path / "pyvenv.cfg").exists():
                continue
            within = f"{above}{entry.name}/"
            if aside is not None and not is_clutter(entry.name):
                yield from _below(path, within, depth + 1, left, aside)
            elif lies_aside(f"{within}any.py"):
                if aside is None:
                    yield from _below(path, within, depth + 1, left, None)
                else:
                    aside.append((path, within, depth + 1))
        elif is_clutter(entry.name):
            continue
        elif entry.is_file(follow_symlinks=False) and not is_meant(entry.name, MANIFEST):
            yield above + entry.name, path


def _outlined(
    name: str, path: Path, skip: tuple[str, ...], functions: tuple[str, ...]
) -> tuple[list[Candidate], int]:
    """The functions in a file, or in an archive's files except those to skip; how much code was parsed."""
    shown = one_line(os.fsencode(name).decode("utf-8", "backslashreplace"))
    try:
        outlines = reader.outlines(path, skip, functions)
    except RefusedError as refused:
        killed = refused.problem.code == "unreadable"
        why = refused.problem.message.removeprefix(f"{quoted(path.name)}: ").rstrip(".")
        return [Candidate(shown, os.fsencode(path), sha256="" if killed else shown, kind=why)], 0
    candidates = []
    for member, sha256, defines, written, code, _, kind in outlines:
        inside = f"{shown}/{one_line(member)}" if member else shown
        about = (inside, os.fsencode(path), member, sha256, defines)
        candidates.append(Candidate(*about, kind=kind, written=written, code=code))
    return candidates, sum(parsed for *_, parsed, _ in outlines)


def found_for(
    exercise: Exercise, candidates: Iterable[Candidate], *, asked: Collection[Candidate]
) -> tuple[Candidate, ...]:
    """The files that may be meant for an exercise, the likeliest first, with the one match if there is one.

    The one in which most functions are written is the match; names decide only where no file has any.

    Args:
        asked: files that may be meant for it whatever they are called.
    """
    tasks = [task.id for task in exercise.task]
    stem = Path(exercise.module).stem.casefold()
    ranked: list[tuple[float, float, Candidate]] = []
    candidates = list(candidates)
    # What lies in a build folder may be an older copy of what lies outside.
    outside = any(not lies_aside(one.name) and set(tasks) & set(one.written) for one in candidates)
    for one in candidates:
        mine = tuple(name for name in tasks if name in one.defines)
        written = tuple(name for name in mine if name in one.written)
        alike = difflib.SequenceMatcher(None, stem, Path(plain(Path(one.name).name)).stem).ratio()
        alike = alike if alike >= _ALIKE else 0.0
        if mine or alike or one in asked:
            # What cannot be read as code can be named, and not proposed.
            worth, alike = len(written), alike + 0.1 * bool(mine)
            if one.kind not in IS_CODE or (outside and lies_aside(one.name)):
                worth, alike = 0, 0.0
            ranked.append((worth, alike, msgspec.structs.replace(one, defines=mine, written=written)))
    ranked.sort(key=lambda item: (-item[0], -item[1], *_by_name(item[2])))
    most = ranked[0][0] if ranked else 0
    # A notebook and a module with its code are one.
    modules = {one.code for worth, _, one in ranked if worth and not _is_notebook(one)}
    distinct = {
        one.sha256: worth or alike
        for worth, alike, one in reversed(ranked)
        if not (_is_notebook(one) and one.code in modules)
    }
    best = most or max(distinct.values(), default=0.0)
    # Two equally good files that differ: the grader must not decide which one counts.
    clear = best > 0 and list(distinct.values()).count(best) == 1
    found = [one for *_, one in ranked]
    return tuple(msgspec.structs.replace(one, proposed=clear and one is found[0]) for one in found)


def _by_name(one: Candidate) -> tuple[bool, bool, str]:
    """The order of files that are worth the same."""
    return not one.name.casefold().endswith(HANDED_IN), _is_notebook(one), one.name


def _is_notebook(one: Candidate) -> bool:
    return one.kind == "a notebook" or one.name.casefold().endswith(".ipynb")


def described(candidates: Sequence[Candidate]) -> str:
    """Files and their functions, as part of a sentence."""
    told = []
    for one in candidates:
        names = ", ".join(one.defines[:_SHOWN]) + (", ..." if len(one.defines) > _SHOWN else "")
        facts = [*filter(None, [one.kind]), *([f"defines {names}"] if names else [])]
        told.append(quoted(one.name) + (f" ({', '.join(facts)})" if facts else ""))
    return some(told, _SHOWN)
