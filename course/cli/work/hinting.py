"""``course hint`` and ``course solution``: as much help as the student has worked for.

Hints come one at a time, and each needs an attempt since the last one: a failed check of changed code. The
next hint fits that check's diagnosis, or else is the mildest one left. The number left is never shown,
because students who see a countdown click through it.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from course.cli.frame.arguments import ExerciseName  # noqa: TC001 - typer reads annotations at run time
from course.cli.frame.completion import task_ids
from course.cli.frame.here import Here
from course.cli.frame.replies import NextStep
from course.cli.frame.terminal.console import Console, current
from course.cli.home.advice import after_warm_up
from course.cli.work.chosen import asked_for, chosen_work
from course.cli.work.replies import Hint, Solution
from course.errors import CourseError, IntegrityError, MissingCapabilityError, NotFoundError
from course.progress.history import fingerprint

if TYPE_CHECKING:
    from collections.abc import Mapping

    from course.catalog.models import Exercise
    from course.progress.history import History

__all__ = ["give_hint", "hint", "solution"]

PACKS = "*.coursepack"


def hint(
    exercise: ExerciseName = None,
    task: Annotated[
        str | None,
        typer.Option(
            metavar="FUNCTION", help="About this function, not the first that fails.", autocompletion=task_ids
        ),
    ] = None,
) -> int:
    """Show the next hint.

    A new hint is due after a check that failed on changed code; comments and layout do not count as a change.
    Until then the last hint is shown again.
    """

    console, here = current(), Here.load()
    chosen, named = asked_for(here, exercise)
    reply = give_hint(console, here, chosen, task, named)
    console.next(reply.next.command)
    for warning in here.warnings:
        console.warn(warning)
    console.emit(reply)
    return 0


def give_hint(
    console: Console, here: Here, exercise: Exercise, task: str | None = None, named: str | None = None
) -> Hint:
    """Show the next hint that is due, or why none is.

    Args:
        task: about this function, not the first that fails.
        named: the file that was named, to be called by its name.
    """
    reply = _next_hint(here, exercise, task, named)
    if reply.task is not None and not console.quiet:
        console.heading(exercise.task_titled(reply.task), reply.task)
    if reply.hint is not None:
        console.line(reply.hint)
    if reply.message:
        console.line(reply.message)
    return reply


def _next_hint(here: Here, exercise: Exercise, wanted: str | None, named: str | None) -> Hint:
    """Decide what to show, and record it if it is new.

    Args:
        named: the file that was named, to be called by its name.
    """

    history = here.history(exercise)
    started = exercise.id in here.workspace.started()
    again = f"course check {exercise.id}" if started else f"course start {exercise.id}"
    task = _task(exercise, history, wanted)
    last = history.last
    if last is None:
        return _no_hint(
            exercise, "not_checked", "Hints follow a check that failed. Check your work first.", again
        )
    if last.state != "graded":
        message = "Your file could not be run at the last check; what that check said is the hint for now."
        return _no_hint(exercise, "ungradable", message, again)
    if task is None:
        which = f"Every public check of {wanted} passes" if wanted else "Every public check passes"
        done = after_warm_up(here, exercise) if exercise.is_warm_up else "course submit"
        step = again if wanted else done
        return _no_hint(exercise, "passing", f"{which}: there is nothing to hint at.", step)
    known = here.catalog.hints(exercise)
    hints, shown, failed = known.of(task), history.hints_for(task), history.diagnosed(task)
    begun = task not in history.unwritten_tasks()
    if not begun or not history.hint_is_due(fingerprint(here.stub(exercise))):
        shown_last = next((index for index in reversed(shown) if index < len(hints.hints)), None)
        last_words = None if shown_last is None else hints.said(shown_last, failed)
        return _not_due(exercise, task, last_words, named or _file_name(here, exercise))
    following = known.after(task, {code for code, _ in failed}, shown)
    if following is None:
        message = (
            f"Every hint for this function has been given; you have worked for all of them. "
            f"Read the lesson again with this function beside it: course lesson {exercise.lesson}. "
            "A solution can be shown after a pass, where one was released."
        )
        return _no_hint(exercise, "exhausted", message, f"course lesson {exercise.lesson}", task)
    here.record("hint", exercise.id, {"task": task, "index": following, "fingerprint": last.fingerprint})
    return _hint(exercise, given=True, task=task, hint=hints.said(following, failed), step=again)


def _task(exercise: Exercise, history: History, wanted: str | None) -> str | None:
    """The task to hint at: the one asked for if it fails, or the first that does and was begun."""
    failing, new = history.failing_tasks(), history.unwritten_tasks()
    known = [task.id for task in exercise.task]
    if wanted is not None and wanted not in known:
        raise NotFoundError(
            f"{exercise.id} has no function called {wanted!r}.",
            help=f"It has: {', '.join(known)}.",
            code="task_not_found",
        )
    candidates = known if wanted is None else [wanted]
    found = [task for task in candidates if task in failing]
    return next((task for task in found if task not in new), found[0] if found else None)


def _file_name(here: Here, exercise: Exercise) -> str:
    """The file that the student works in, as far as it is known."""
    try:
        return chosen_work(here, exercise).name
    except CourseError:
        return exercise.module


def _not_due(exercise: Exercise, task: str, last: str | None, file: str) -> Hint:
    if last is None:
        message = (
            f"The first hint follows an attempt at this function. Write something in {file}, however rough, "
            "and check it; then ask again."
        )
    else:
        message = (
            "You have had that one already. The next one follows a check that fails on changed code in "
            f"{file}."
        )
    return _hint(
        exercise,
        reason="unchanged",
        task=task,
        hint=last,
        message=message,
        step=f"course check {exercise.id}",
    )


def _no_hint(exercise: Exercise, reason: str, message: str, step: str, task: str | None = None) -> Hint:
    return _hint(exercise, reason=reason, task=task, message=message, step=step)


def _hint(
    exercise: Exercise,
    *,
    step: str,
    given: bool = False,
    reason: str = "",
    task: str | None = None,
    hint: str | None = None,
    message: str = "",
) -> Hint:
    return Hint(
        exercise=exercise.id,
        given=given,
        reason=reason,
        task=task,
        hint=hint,
        message=message,
        next=NextStep(step),
    )


def solution(exercise: ExerciseName = None) -> int:
    """Show a released solution, after a pass.

    Once a check of yours has reached the pass mark, this shows the solution if your instructor has handed
    one out: put the .coursepack file into the workspace.
    """

    console, here = current(), Here.load()
    chosen = here.exercise(exercise)
    if here.history(chosen).first_pass is None:
        raise NotFoundError(
            f"No check of {chosen.id} has reached the pass mark yet, and a solution read before that "
            "teaches little.",
            help=f"Go on with `course check {chosen.id}` and `course hint {chosen.id}`.",
            code="not_passed",
        )
    source, files = _released(here, chosen)
    _show_files(console, source, files)
    here.record("solution", chosen.id, {"source": source})
    for warning in here.warnings:
        console.warn(warning)
    console.emit(Solution(exercise=chosen.id, source=source, files=dict(files)))
    return 0


def _released(here: Here, exercise: Exercise) -> tuple[str, Mapping[str, str]]:
    """A solution's source, and its files.

    Raises:
        NotFoundError: none was released to this machine.
        IntegrityError: a pack that may hold it is damaged.
    """
    problem: IntegrityError | MissingCapabilityError | None = None
    for path in sorted(here.workspace.root.glob(PACKS)):
        from course.catalog.pack import read_pack

        try:
            pack = read_pack(path)
        except (IntegrityError, MissingCapabilityError) as error:
            problem = error
            continue
        if exercise.id in pack.solutions and pack.course_id == here.catalog.course_id:
            return str(path), _texts(pack.solutions[exercise.id])
    folder = here.catalog.content.solution_folder(exercise.id)
    if folder is not None and (folder / exercise.module).is_file():
        found = [folder / name for name in (exercise.module, "README.md")]
        return str(folder), _texts({p.name: p.read_bytes() for p in found if p.is_file()})
    if problem is not None:
        raise problem
    raise NotFoundError(
        f"No solution of {exercise.id} has been released to this machine.",
        help=f"Your instructor hands one out as a .coursepack file; put it into {here.workspace.root}.",
        code="no_solution",
    )


def _texts(files: Mapping[str, bytes]) -> dict[str, str]:
    return {name: data.decode("utf-8", "replace") for name, data in sorted(files.items())}


def _show_files(console: Console, source: str, files: Mapping[str, str]) -> None:
    console.note(f"From {source}")
    for name, text in files.items():
        if not console.quiet:
            console.heading(name)
        console.block(text, language="python" if Path(name).suffix == ".py" else "")
