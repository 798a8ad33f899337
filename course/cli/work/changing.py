"""``course start``, ``diff``, ``reset`` and ``update``: the stub, and newer versions of it.

Every replaced file is copied to ``.course/backups`` first, and the copy's path is printed.
"""

import contextlib
import difflib
from collections.abc import Iterator
from pathlib import Path
from typing import Annotated

import msgspec

from course.catalog.models import Exercise
from course.cli.frame.console import Console, current
from course.cli.frame.here import Here, write
from course.cli.frame.options import ExerciseName, OneExercise, argument, exercise_ids, option
from course.cli.frame.replies import Backup, Envelope, FileReply, NextStep
from course.cli.work.checking import report_source_file
from course.cli.work.chosen import asked_for, chosen_work, name_of_work
from course.errors import MissingCapabilityError, NotFoundError, UsageError
from course.handed_in.limits import read_notebook
from course.notebooks.merge import CannotMergeError, is_untouched, merged
from course.printable import counted
from course.progress.workspace import same_text


class Diff(Envelope, tag="course.diff/1", frozen=True, kw_only=True):
    exercise: str
    path: str
    changed: bool
    added: int
    removed: int
    diff: str


class Reset(Envelope, tag="course.reset/1", frozen=True, kw_only=True):
    exercise: str
    changed: bool
    backups: tuple[Backup, ...]
    next: NextStep


class Change(msgspec.Struct, frozen=True):
    """The action of ``update`` on one file.

    ``action`` is "replace" (it was never edited), "beside" (it was: the new one is at ``new``), "merge" (a
    notebook: newer text was put around the student's work), "current" (already so) or "missing" (removed by
    the student, and left so).
    """

    path: str
    action: str
    new: str | None = None
    backup: str | None = None


class Update(Envelope, tag="course.update/1", frozen=True, kw_only=True):
    dry_run: bool
    from_version: str
    to_version: str
    changes: tuple[Change, ...]


class Start(Envelope, tag="course.start/1", frozen=True, kw_only=True):
    exercise: str
    files: tuple[FileReply, ...]
    next: NextStep


def diff(exercise: ExerciseName = None) -> int:
    """Show what changed since the stub.

    A unified diff: lines you removed begin with -, lines you added with +. Of a notebook it shows the code
    that is graded.
    """
    console, here = current(), Here.load()
    work = chosen_work(here, *asked_for(here, exercise))
    report_source_file(console, here, work)
    name = work.path
    before, after = (one.decode("utf-8-sig", "replace").splitlines() for one in (work.stub, work.source))
    rows = list(difflib.unified_diff(before, after, f"stub/{name}", name, lineterm=""))
    added = sum(row.startswith("+") for row in rows[2:])
    removed = sum(row.startswith("-") for row in rows[2:])
    if rows:
        styles = {"+": "green", "-": "red", "@": "cyan"}
        for row in rows:
            console.line((row, styles.get(row[:1], "")))
        console.note(f"{counted(added, 'line')} added, {removed} removed.")
    else:
        console.line(f"{name} is as it was handed out.")
    return here.answer(
        Diff(
            exercise=work.exercise.id,
            path=str(here.workspace.path(work.exercise.place, work.name)),
            changed=bool(rows),
            added=added,
            removed=removed,
            diff="".join(f"{row}\n" for row in rows),
        )
    )


def reset(exercise: OneExercise, yes: Annotated[bool, option("--yes -y", "Do not ask.")] = False) -> int:
    """Go back to the stub; a copy is kept.

    Asks first on a terminal; anywhere else it needs --yes. The copy's path is printed.
    """
    console, here = current(), Here.load()
    chosen = here.exercise(exercise)
    path = here.workspace.path(chosen.place, name_of_work(here, chosen))
    stub = chosen.stub_path.read_bytes()
    if path.name != chosen.module:
        from course.notebooks.build import exercise_notebook

        stub = exercise_notebook(here.catalog, chosen)
    shown = here.workspace.shown(path)
    step = f"course check {chosen.id}"
    there = path.is_file()
    if not there and chosen.id not in here.workspace.started() and here.known_history(chosen).last is None:
        problem = f"You have not started {chosen.id}: there is nothing to reset."
        raise NotFoundError(problem, help=f"Start it: `course start {chosen.id}`.", code="not_started")
    why_not = ""
    if there and path.read_bytes() == stub:
        why_not = f"{shown} is the stub already; nothing was changed."
    elif there and not yes and not _agreed(console, shown):
        why_not = "Nothing was changed."
    if why_not:
        console.line(why_not)
        return console.answer(Reset(exercise=chosen.id, changed=False, backups=(), next=NextStep(step)))
    kept = write(path, stub, why="reset").backup
    if kept:
        console.line(f"Your version is kept at {here.workspace.shown(Path(kept.backup))}.")
    if path.name == chosen.module:
        here.workspace.remember(chosen.place, chosen.module, stub)
    backups = (kept,) if kept else ()
    here.record("reset", chosen.id, {"backups": [item.backup for item in backups]})
    console.line(f"{shown} is the stub again.")
    return here.answer(Reset(exercise=chosen.id, changed=True, backups=backups, next=NextStep(step)))


def update(dry_run: Annotated[bool, option("--dry-run", "Only print what would be done.")] = False) -> int:
    """Bring newer course content in.

    For exercises you started: a file that you never edited is replaced (a copy is kept). A file that you
    edited stays, and the newer one is put beside it as NAME.new. In a notebook the newer text is put around
    your work.
    """
    console, here = current(), Here.load()
    old, new = here.workspace.version, here.catalog.version
    if here.workspace.is_newer(new):
        problem = f"{here.workspace.root} is at version {old}, and the installed course is older: {new}."
        fix = f"Install version {old} of the course or a later one; nothing here was changed."
        raise MissingCapabilityError(problem, help=fix, code="workspace_newer")
    changes = tuple(_updates(here, dry_run=dry_run))
    was, put = ("would be", "would be put") if dry_run else ("was", "is")
    for change in changes:
        name, beside, old_one = (
            here.workspace.shown(Path(path or "")) for path in (change.path, change.new, change.backup)
        )
        kept = f" The old one is kept at {old_one}." if change.backup else ""
        said = {
            "replace": f"{was} replaced by the newer one; you had not edited it.{kept}",
            "merge": f"newer text {was} put around your work.{kept}",
            "beside": f"you edited it, so it stays; the newer one {put} beside it as {beside}.{kept}",
            "missing": "not there, and left so; `course start` would put it back.",
            "current": "up to date.",
        }
        console.line(f"{name}: {said[change.action]}")
    if not any(change.action in {"replace", "beside", "merge"} for change in changes):
        console.line("Everything here is up to date with the installed course.")
    elif dry_run:
        console.note("Nothing was changed. To do it: course update")
    if not dry_run:
        if old != new:
            here.workspace.note_version(new)
            console.line(f"The workspace is at version {new} now (it was {old}).")
        here.record("update", "", {"from": old, "to": new, "changes": [[c.path, c.action] for c in changes]})
    return here.answer(Update(dry_run=dry_run, from_version=old, to_version=new, changes=changes))


def _agreed(console: Console, shown: str) -> bool:
    if not console.interactive:
        problem = f"This would replace {shown}, and there is no terminal to ask on."
        raise UsageError(problem, help="Add --yes; a copy of the file is kept.", code="needs_yes")
    return console.confirm(f"Replace {shown} with the stub? A copy of yours is kept.")


def _updates(here: Here, *, dry_run: bool) -> Iterator[Change]:
    for exercise in here.started():
        for source in exercise.given:
            yield _update_file(here, exercise, source.name, source.read_bytes(), dry_run=dry_run)
    from course.notebooks.build import WORKSPACE, generate  # a lesson opens without it

    for notebook in generate(here.catalog, layout=WORKSPACE, there=here.workspace.root):
        path, new, action = here.workspace.root / notebook.path, notebook.data, "beside"
        mine = read_notebook(path)
        with contextlib.suppress(CannotMergeError):  # newer text is put around the student's work
            new = merged(mine, notebook.data)
            action = "current" if new == mine else "replace" if is_untouched(mine) else "merge"
        yield _put(path, f"{path.stem}.new.ipynb", new, action, dry_run=dry_run or action == "current")


def _update_file(here: Here, exercise: Exercise, name: str, new: bytes, *, dry_run: bool) -> Change:
    workspace = here.workspace
    path = workspace.path(exercise.place, name)
    given = workspace.given(exercise.place, name)
    if not path.is_file():
        return Change(path=str(path), action="missing")
    mine = path.read_bytes()
    if same_text(mine, new):
        action = "current"
    elif given is not None and same_text(given, new):
        return Change(path=str(path), action="current")  # edited by the student, and nothing newer to offer
    else:
        action = "replace" if given is not None and same_text(given, mine) else "beside"
    change = _put(path, f"{name}.new", new, action, dry_run=dry_run or action == "current")
    if not dry_run and given != new:
        workspace.remember(exercise.place, name, new)
    return change


def _put(path: Path, beside: str, new: bytes, action: str, *, dry_run: bool) -> Change:
    """Write the newer content where the action wants it, with a copy of what it replaces."""
    to = path.with_name(beside) if action == "beside" else path
    kept = None if dry_run else write(to, new, why="update").backup
    return Change(str(path), action, str(to) if to != path else None, kept.backup if kept else None)


# ---
# ``course start``: an exercise in the workspace. Nothing is overwritten.


#: How fast technical text is read. Brysbaert's mean for non-fiction is 238 (J. Mem. Lang. 109, 2019).
_WORDS_A_MINUTE = 200
#: Minutes from which on the length is told.
_LONG = 3


def start(
    exercise: Annotated[str | None, argument("EXERCISE", "Its id or its number.", exercise_ids)] = None,
) -> int:
    """Put an exercise into the workspace.

    You get the stub to fill in and its README. An existing file is not changed.
    """
    console, here = current(), Here.load()
    if exercise is None:
        raise UsageError(
            "Which exercise?",
            help=f"Known: {', '.join(one.id for one in here.catalog.exercises())}. "
            "`course warmup` lists the small tasks.",
            code="no_name",
        )
    chosen = here.exercise(exercise)
    files = put(console, here, chosen)
    step = f"course watch {chosen.id}"
    tell_length(console, here, chosen)
    console.note(f"Then check it on every save: {step}")
    console.note(f"Or once, now and then: course check {chosen.id}")
    return here.answer(Start(exercise=chosen.id, files=files, next=NextStep(step)))


def tell_length(console: Console, here: Here, chosen: Exercise) -> None:
    """Where an exercise is to be read and to be written, and how long reading takes."""
    minutes = max(1, round(len(chosen.readme_path.read_text(encoding="utf-8").split()) / _WORDS_A_MINUTE))
    work = f"{chosen.place}/{name_of_work(here, chosen)}"
    console.note(f"Read {chosen.place}/README.md, write your code in {work}.")
    if minutes > _LONG:
        console.note(f"It takes {minutes} minutes to read; you can begin after the first function's section.")


def put(console: Console, here: Here, chosen: Exercise) -> tuple[FileReply, ...]:
    """Put the files of an exercise into the workspace where they are not there yet.

    It says so, unless one task leads to the next.
    """
    files = []
    for source in chosen.given:
        target = here.workspace.path(chosen.place, source.name)
        new = here.workspace.give(chosen.place, source.name, source.read_bytes())
        files.append(FileReply(path=str(target), action="created" if new else "kept"))
        verb = "created" if new else "exists already and was not changed"
        if not console.led:
            console.line(f"{here.workspace.shown(target)} {verb}.")
    here.record("start", chosen.id, {"version": here.catalog.version})
    return tuple(files)
