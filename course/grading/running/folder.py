"""The folder of a run: created, opened for later commands, and its files written anew."""

import contextlib
import shutil
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

import msgspec

from course.errors import MissingCapabilityError, UsageError
from course.grading.exports.grades import write_csv, write_jsonl
from course.grading.gradebook.book import Gradebook
from course.grading.gradebook.file import rescue
from course.grading.gradebook.records import Looked
from course.grading.gradebook.salvage import back_up
from course.grading.results.effective import Results, recorded
from course.grading.results.merge import Merged, merged
from course.grading.results.roster import Roster
from course.isolation.launch import private_folder, remove_tree

#: The gradebook's name in a run's folder.
BOOK = "gradebook.sqlite"


@dataclass
class ClaimedName:
    """A run's reserved folder. ``graded``: whether any grader could work."""

    graded: bool = False


@contextlib.contextmanager
def taken_back(out: Path) -> Iterator[ClaimedName]:
    """Remove a new folder again if the run is refused before anything was graded.

    The user will correct the command and repeat it, and its folder must not be in the way.
    """
    new, taken = not out.exists(), ClaimedName()
    try:
        yield taken
    except BaseException:
        if new and not taken.graded and out.is_dir():
            for item in out.iterdir():
                item.unlink()
            out.rmdir()
        raise


def begin(out: Path, submissions: Path, *, resume: bool) -> Gradebook:
    """The gradebook of a new run or, with ``resume``, of an earlier one, opened for writing."""
    if out.resolve().is_relative_to(submissions.resolve()):
        message = f"--out {out} lies among the submissions."
        raise UsageError(message, help="Name a folder elsewhere.", code="out_inside_submissions")
    path = out / BOOK
    if resume and path.exists():
        return Gradebook(path, writing=True)
    try:
        make_folder(out, exist_ok=False)
    except FileExistsError:
        # A run that was killed before it made its gradebook leaves the folder and perhaps the draft.
        there = out.is_dir() and all(item.name.startswith("gradebook.new") for item in out.iterdir())
        if not (resume and there):
            what = "has no gradebook" if resume and out.is_dir() else "exists already"
            more = ", or add --resume to finish the run that is there" if path.exists() else ""
            advice = rescue(path, "Name the folder of the run.") if resume else f"Name a new folder{more}."
            message = f"{out} {what}; nothing was touched."
            raise UsageError(message, help=advice, code="out_exists") from None
        for draft in out.iterdir():
            draft.unlink(missing_ok=True)
    return Gradebook(path, create=True, writing=True)


def make_folder(out: Path, *, exist_ok: bool = True) -> None:
    """Make a folder for a gradebook, and those above it.

    Raises:
        FileExistsError: it is there, and should not be.
        MissingCapabilityError: it cannot be made.
    """
    try:
        out.mkdir(parents=True, exist_ok=exist_ok)
    except FileExistsError:
        raise
    except OSError as error:
        message = f"{out} cannot be made: {error.strerror}."
        advice = "Name a folder that can be written."
        raise MissingCapabilityError(message, help=advice, code="read_only") from None


def export_all(out: Path, results: Results) -> None:
    """The files that lie beside a gradebook after every run."""
    from course.grading.exports.html_report.pages import write_pages

    try:
        write_jsonl(out / "results.jsonl", results.all(), results.course)
        write_csv(out / "grades.csv", results, results.all())
        write_pages(out / "report.html", results, results.all(), [item.id for item in results.exercises()])
    except MissingCapabilityError as error:
        advice = (
            "The gradebook is complete. Make room, then give the same command again (a run with"
            " --resume): only this is missing. `course grade export` writes it elsewhere."
        )
        raise MissingCapabilityError(error.message, help=advice, code=error.code) from None


@contextlib.contextmanager
def open_results(out: Path, *, writing: bool = False) -> Iterator[Results]:
    """The results in the folder of a grading run.

    Args:
        writing: lock the gradebook; at the end write the files beside it anew, and a backup.
    """
    with Gradebook(out / BOOK, writing=writing) as book:
        yield Results(book)
        if writing:
            export_all(out, Results(book))
    if writing:
        back_up(out / BOOK)


@contextlib.contextmanager
def previewed(out: Path) -> Iterator[Results]:
    """A run's results, on which to try a change: a copy of the gradebook, which is thrown away, so that the
    preview cannot differ from the real one."""
    path = out / BOOK
    Gradebook(path).close()  # it is complete, no process is writing it, and it is one file now
    folder = private_folder()
    try:
        shutil.copyfile(path, folder / path.name)
        with Gradebook(folder / path.name, writing=True) as book:
            results = Results(book)
            results.folder = out
            yield results
    finally:
        remove_tree(folder)


def remember(book: Gradebook, new: Roster) -> Merged:
    """Merge a roster into the stored one; the scores that change by it (an extension) are recorded."""
    found = merged(Results(book), new, lasting=True)
    text, before = found.roster.dump(), book.meta().get("roster")
    if text == before:
        return found
    if before is None and not book.exercise_ids():
        book.set_meta(roster=text)
        return found
    with recorded(book, "roster", f"roster {new.file}" if new.file else "another roster") as moved:
        book.set_meta(roster=text)
    found.moved = moved
    return found


def note_looked(
    book: Gradebook, exercises: Iterable[str], read: set[str], others: set[str], *, named: bool
) -> None:
    """Note that a run looks for these exercises: in all of a class, or in a part of it.

    Args:
        others: students with a folder that this run leaves aside.
    """
    looked = book.looked()
    if looked is None:
        known = (*book.exercise_ids(), *(one.id for one in book.exercises()))
        looked = {name: Looked(whole=True) for name in known}
    new = others - {*book.student_ids(), *book.without_work()}
    looked = {name: one.without(new) for name, one in looked.items()}
    for name in exercises:
        was = looked.get(name, Looked()).having(read)
        if not others:
            was = msgspec.structs.replace(was, whole=True, names=frozenset())
        looked[name] = msgspec.structs.replace(was, named=was.named or named)
    book.set_looked(looked)


def note_unread(book: Gradebook, unread: Iterable[tuple[str, str]]) -> None:
    """Note work that a run passed over, of exercises that were looked for before."""
    looked = book.looked() or {}
    for student, exercise in unread:
        if exercise in looked:
            looked[exercise] = looked[exercise].without({student})
    book.set_looked(looked)


def note_without_work(book: Gradebook, students: set[str]) -> None:
    """Keep the names of the students in whose folders there is nothing to grade: no result names them."""
    names = sorted({*book.without_work(), *students} - set(book.student_ids()))
    book.set_meta(without_work=msgspec.json.encode(names).decode() if names else None)
