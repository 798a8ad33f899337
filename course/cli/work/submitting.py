"""``course submit``: one zip with the student's work; the same files give the same bytes.

What goes in is checked before it is written, from the very bytes that go in: what is said of a file here is
what the public checks of a grading run find in it.
"""

import hashlib
import io
import json
import zipfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import msgspec

from course.catalog.models import CourseRef, Exercise
from course.catalog.pack import zip_entry
from course.cli.frame.console import Console, current
from course.cli.frame.here import Here, named
from course.cli.frame.options import argument, exercise_ids, option
from course.cli.frame.replies import Envelope, FileReply
from course.cli.work.chosen import StudentWork, work_of
from course.errors import CourseError, UngradableError, UsageError
from course.handed_in import attempts
from course.handed_in.limits import FORMAT_VERSION, MANIFEST, MAX_UNPACKED
from course.printable import command, counted
from course.progress.history import fingerprint
from course.progress.quiz import quiz_history, records
from course.progress.workspace import write_atomically
from course.scoring.verdict import Verdict, format_points


class SubmitFile(msgspec.Struct, frozen=True):
    """A file that goes in. ``last_score`` is what the public checks give these bytes; None if nothing."""

    path: str
    sha256: str
    bytes: int
    last_score: float | None = None
    max_score: float | None = None


class Submit(Envelope, tag="course.submit/1", frozen=True, kw_only=True):
    course: CourseRef
    output: str
    files: tuple[SubmitFile, ...]
    left_out: tuple[FileReply, ...]
    quiz_attempts: int = 0
    backup: str | None = None
    warnings: tuple[str, ...] = ()


def submit(
    exercises: Annotated[
        list[str] | None,
        argument("[EXERCISE]...", "Only these, without the quiz; everything if left out.", exercise_ids),
    ] = None,
    output: Annotated[
        Path | None, option("-o --output FILE", "File to write; in the workspace if left out.")
    ] = None,
    warm_ups: Annotated[
        bool, option("--warm-ups", "The warm-ups you worked on go in, too; they do not count.")
    ] = False,
) -> int:
    """Write the file to hand in.

    First checks what will go in, just as it will be read when it is graded, and shows it. An exercise whose
    file is still the stub is left out; if you worked in its notebook instead, the notebook is handed in,
    without its outputs. If the file to write exists, a copy of it is kept.
    """
    console, here = current(), Here.load()
    only = tuple({one.id: one for one in map(here.exercise, exercises or ())}.values())
    target = _target(here, output, only)
    works, left_out = work_of(here, only, warm_ups=warm_ups)
    quiz = [] if only else _quiz_records(here)
    goes_in = _checked(console, here, works)
    files = tuple(one.reply() for one in goes_in)
    _show(console, here, goes_in, left_out, quiz, only)
    if not works and not quiz:
        new = [one.id for one in only if one.id not in here.workspace.started() and not left_out]
        begin = f"{command('start', new[0])} begins it." if new else ""
        raise UngradableError(
            f"You have not started {', '.join(new)}." if new else "There is nothing to hand in yet.",
            help=begin or "Write an exercise first, or take the quiz.",
            code="nothing_to_submit",
        )
    notes = [note for one in goes_in for note in (*one.work.notes, *one.notes)]
    data = _packed(here, works, quiz)
    replaces = target.exists() and target.read_bytes() != data
    backup = str(here.workspace.backup(target, "submit")) if replaces else None
    write_atomically(target, data)
    here.record("submit", "", {"output": str(target), "sha256": hashlib.sha256(data).hexdigest()})
    if backup:
        console.line(f"There was a file of that name; it is kept at {here.workspace.shown(Path(backup))}.")
    console.line((f"Wrote {target}.", "bold"))
    console.note("Hand in that file. Hidden checks run when it is graded.")
    here.warnings = [*notes, *here.warnings]  # of the work first, then of the record
    return here.answer(
        Submit(
            course=here.course,
            output=str(target),
            files=files,
            left_out=tuple(left_out),
            quiz_attempts=len(quiz),
            backup=backup,
            warnings=tuple(notes),
        )
    )


def _packed(here: Here, works: Sequence[StudentWork], quiz: Sequence[Mapping[str, object]]) -> bytes:
    """The zip: each file, and ``submission.json`` with its checksum and this Python's and NumPy's versions.

    The same arguments, the same bytes.

    Args:
        quiz: attempts as ``course.progress.quiz.records`` gives them; a grading run scores them again.

    Raises:
        UngradableError: no grading run would take it.
    """
    from course.scoring import versions

    files = {work.path: work.data for work in works}
    manifest = {
        "format_version": FORMAT_VERSION,
        "written_with": versions.here(),
        "course": {"id": here.catalog.course_id, "version": here.catalog.version},
        "files": {path: hashlib.sha256(data).hexdigest() for path, data in sorted(files.items())},
        "quiz": list(quiz),
    }
    entries = {**files, MANIFEST: (json.dumps(manifest, indent=2, sort_keys=True) + "\n").encode()}
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_STORED) as packed:
        for path in sorted(entries):
            packed.writestr(zip_entry(path), entries[path])
    data = buffer.getvalue()
    if len(data) > MAX_UNPACKED:
        problem = f"Together the files are larger than {MAX_UNPACKED:,} bytes, which no grading run unpacks."
        raise UngradableError(problem, help="Keep data out of them.", code="too_large")
    return data


def _target(here: Here, output: Path | None, only: Sequence[Exercise]) -> Path:
    """Where the zip goes, before anything is read."""
    name = f"{'-'.join(one.id for one in only) or here.catalog.course_id}-submission.zip"
    if output is None:
        return here.workspace.root / name
    path = named(output)
    if path.is_dir():
        path = path / name
    if not path.parent.is_dir():
        raise UsageError(f"There is no folder {path.parent}.", help="Make it, or name another file.")
    if path.suffix.lower() != ".zip":
        problem = f"{path.name} does not end in .zip."
        raise UsageError(problem, help="Name a .zip file with -o.", code="not_a_zip")
    return path


@dataclass(frozen=True)
class _GoesIn:
    """A file that is handed in, and what the public checks say of it.

    Attributes:
        verdict: None if it cannot be checked.
        notes: what else there is to say of it, a sentence each.
    """

    work: StudentWork
    verdict: Verdict | None
    notes: tuple[str, ...]

    def reply(self) -> SubmitFile:
        graded = self.verdict is not None and self.verdict.state == "graded"
        return SubmitFile(
            path=self.work.path,
            sha256=hashlib.sha256(self.work.data).hexdigest(),
            bytes=len(self.work.data),
            last_score=self.verdict.score if graded and self.verdict else None,
            max_score=self.verdict.max_score if graded and self.verdict else None,
        )


def _checked(console: Console, here: Here, works: Sequence[StudentWork]) -> list[_GoesIn]:
    """The files, each checked from the bytes that are handed in."""
    from course.isolation.probe import kept_sandboxes

    found = []
    with kept_sandboxes():
        for work in works:
            with console.working(f"Checking {work.path} as it is handed in"):
                found.append(_check(here, work))
    return found


def _check(here: Here, work: StudentWork) -> _GoesIn:
    try:
        made = attempts.attempt(work.exercise, here.catalog, work.submission)
        last = here.known_history(work.exercise).last_graded
        if last is None or last.fingerprint != fingerprint(
            work.source
        ):  # no check of this very work is known
            here.record("check", work.exercise.id, made.data(here.catalog.version, one_of_many=True))
    except CourseError as error:
        return _GoesIn(work, None, (f"{work.path} could not be checked: {error.message} {error.help}",))
    verdict = made.verdict
    notes = [f"{work.path}: {note.removeprefix(f'{work.name}, ')}" for note in verdict.warnings]
    if (why := verdict.error) is not None:
        notes.insert(0, f"{work.path} cannot be graded as it is: {why.message} {why.help}")
    return _GoesIn(work, verdict, tuple(notes))


def _quiz_records(here: Here) -> list[dict[str, object]]:
    """The attempts at the quiz; none, with a warning, where the record of progress cannot be read."""
    try:
        return records(quiz_history(here.workspace.store.events()))
    except CourseError as error:
        here.warnings.append(f"Attempts at the quiz are left out: {error.message} {error.help}")
        return []


def _show(
    console: Console,
    here: Here,
    goes_in: list[_GoesIn],
    left_out: list[FileReply],
    quiz: Sequence[Mapping[str, Any]],
    only: Sequence[Exercise],
) -> None:
    files = [one.work.path for one in goes_in]
    if files or quiz:
        console.line("This goes in:")
    for one in goes_in:
        console.line(f"{one.work.path}: {len(one.work.data):,} bytes, {_score(one)}", indent=2)
    if quiz:
        best = max(quiz, key=lambda record: record["score"])
        score = f"{counted(len(quiz), 'attempt')}, best {best['score']} of {len(best['questions'])}"
        console.line(f"The quiz: {score}; scored again when graded", indent=2)
    if files or quiz:
        also = "checksums, and which Python and NumPy you have"
        console.line(f"{MANIFEST}: the course ({here.course.id} {here.course.version}), {also}", indent=2)
    for why in dict.fromkeys(item.action for item in left_out):
        console.line(f"Left out: {', '.join(item.path for item in left_out if item.action == why)} ({why}).")
    known = {Path(path).parent.name for path in (*files, *(item.path for item in left_out))}
    missing = [name for name in here.catalog.exercise_ids() if name not in known]
    if files and missing and not only:
        console.line(f"Not started, so not in it: {', '.join(missing)}.")
    if files and not quiz and not only and any(here.catalog.content.quiz.glob("*.toml")):
        console.line("The quiz was not taken, so it is not in it.")


def _score(one: _GoesIn) -> str:
    verdict, exercise = one.verdict, one.work.exercise
    if verdict is None or verdict.state != "graded":
        return "not checked" if verdict is None else "cannot be graded"
    if exercise.is_warm_up:
        return "passes" if verdict.all_pass else "does not pass its checks"
    points = f"{format_points(verdict.score)}/{format_points(verdict.max_score)}"
    mark = f"a pass is {exercise.pass_mark:.0%} of all points, hidden checks included"
    return f"{points} points from the public checks ({mark})"
