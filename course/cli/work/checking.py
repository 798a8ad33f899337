"""``course check``: the public checks, run by the same session as in a grading run."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Annotated

from course.catalog.models import CourseRef
from course.cli.frame.console import Console, current
from course.cli.frame.here import Here
from course.cli.frame.options import ExerciseName, Verbose, check_ids, choice_of, option
from course.cli.frame.replies import ErrorBody, ErrorReply, NextStep, filled
from course.cli.home.advice import next_step
from course.cli.work.chosen import StudentWork, asked_for, chosen_work, worked_on
from course.cli.work.replies import Check, CheckAll, CurveReply
from course.cli.work.verdict import (
    FORMATS,
    annotate,
    annotate_error,
    show_changes,
    show_loading,
    show_verdict,
)
from course.errors import CourseError, UsageError
from course.handed_in import attempts
from course.handed_in.attempts import Attempt
from course.printable import counted
from course.scoring.verdict import Verdict

if TYPE_CHECKING:
    from course.figures.described import Curve


# ---
# The curve of a failed check over the right one: drawn where the terminal can, and always in words.


def curve_replies(made: Attempt) -> tuple[CurveReply, ...]:
    """The curves as ``--json`` prints them."""
    from course.figures.described import thinned

    replies = []
    for check, curve in _curves(made):
        few = thinned(curve)
        points = {name: tuple(getattr(few, name).tolist()) for name in ("t", "yours", "right")}
        replies.append(filled(CurveReply, curve, check=check, **points))
    return tuple(replies)


def show_curve(console: Console, made: Attempt, *, focus: str = "", drawn: bool = True) -> None:
    """Show the first failed check that has a curve; nothing if none has one.

    Args:
        focus: a function whose checks come before those of others.
        drawn: with a picture; else in words alone.
    """
    check, curve = next(_curves(made, focus), ("", None))
    if console.quiet or curve is None:
        return
    from course.figures.described import plot_of
    from course.figures.plots import draw

    if drawn:
        console.figure(lambda: draw(plot_of(curve)))
    else:
        console.gap()
    console.line((f"{check}: {curve.description}", "dim"))
    console.gap()


def _curves(made: Attempt, focus: str = "") -> Iterator[tuple[str, Curve]]:
    """Id and curve of each check that has one, in the order of the tasks."""
    order = [focus, *(task.id for task in made.exercise.task)]
    for check in sorted(
        (check for check in made.verdict.checks if check.id in made.curves),
        key=lambda check: order.index(check.task) if check.task in order else len(order),
    ):
        yield check.id, made.curves[check.id]


def check(
    exercise: ExerciseName = None,
    everything: Annotated[bool, option("--all", "Check every exercise you have started.")] = False,
    only: Annotated[str | None, option("--only CHECK", "Run one check, by its id.", check_ids)] = None,
    verbose: Verbose = False,
    form: Annotated[
        str,
        option(
            "--format text|github|lines",
            "github: annotations for a workflow. lines: file:line: error: what, for an editor.",
            choice_of(*FORMATS),
        ),
    ] = "text",
) -> int:
    """Run the public checks.

    Run them as often as you like. Exit code 0 if every check passes, 1 if one does not, 3 if nothing could be
    checked. If you worked in the notebook instead of the .py file, the notebook is checked.
    """

    from course.isolation.probe import kept_sandboxes

    if form not in FORMATS:
        raise UsageError(f"There is no format {form[:20]!r}.", help=f"Formats: {', '.join(FORMATS)}.")
    console, here = current(), Here.load()
    if everything:
        if exercise is not None or only is not None:
            raise UsageError("--all takes neither an exercise nor --only.", help="Leave one of them out.")
        with kept_sandboxes():
            return _check_all(console, here, verbose=verbose, form=form)
    chosen = chosen_work(here, *asked_for(here, exercise))
    reply = _check_one(here, chosen, only=only or "", verbose=verbose, form=form)
    if reply.next is not None and form == "text":
        console.next(reply.next.command)
    return here.answer(reply)


def report_source_file(console: Console, here: Here, work: StudentWork) -> None:
    """Say which file was read, where there is a choice; warn about the other."""
    if work.notebook is not None or work.notes:
        console.note(f"Reading {work.path}.")
    here.warnings.extend(work.notes)


def reply_to(
    course: CourseRef,
    verdict: Verdict,
    step: str = "",
    printed: str = "",
    curves: tuple[CurveReply, ...] = (),
) -> Check:
    """The answer that ``--json`` prints for a verdict.

    Args:
        printed: the file's output while it was loaded.
        curves: of its failed checks.
    """
    code, following = 0 if verdict.all_pass else 1, NextStep(step) if step else None
    return filled(
        Check, verdict, exit_code=code, course=course, next=following, printed=printed, curves=curves
    )


def _check_one(
    here: Here, work: StudentWork, *, verbose: bool, form: str, only: str = "", one_of_many: bool = False
) -> Check:
    """Check, record, show; raises the error if it cannot be checked."""
    console, exercise, last = current(), work.exercise, here.known_history(work.exercise).last
    if form == "text":
        report_source_file(console, here, work)
    took = f", about {last.seconds:.0f} s" if last is not None and last.seconds >= 1 else ""
    with console.working(f"Checking {exercise.id}{took}"):
        made = attempts.attempt(exercise, here.catalog, work.submission, only)
    verdict = made.verdict
    here.record("check", exercise.id, made.data(here.catalog.version, one_of_many=one_of_many))
    if form == "text":
        show_loading(console, made.printed, whole=verbose)
    if made.problem is not None:
        if form != "text":
            annotate_error(console, here, work, made.problem, form)
        raise made.problem
    if form == "text":
        # For a small warm-up, one finding at a time is enough.
        brief = exercise.is_warm_up and not verbose
        if console.draws:  # above, so that the finding stays on the screen
            show_curve(console, made)
        if not only:  # first the functions that the last edit broke, and those that it fixed
            fixed, broke = (
                [f"{task.title}  [{task.id}]" for task in exercise.task if task.id in changed]
                for changed in here.known_history(exercise).changed_tasks()
            )
            show_changes(console, broke, fixed)
        show_verdict(console, exercise, verdict, verbose=verbose, whole=not only, brief=brief)
        if not console.draws:
            show_curve(console, made, drawn=False)
    else:
        annotate(console, here, work, verdict, form)
    step = next_step(here, made) if not only or not verdict.all_pass else ""
    again = f"course check {exercise.id}"
    return reply_to(here.course, verdict, step or again, made.printed, curve_replies(made))


def _check_all(console: Console, here: Here, *, verbose: bool, form: str) -> int:
    results: list[Check | ErrorReply] = []
    for exercise in worked_on(here):
        if form == "text":
            console.heading(exercise.id)
        try:
            work = chosen_work(here, exercise)
            results.append(_check_one(here, work, one_of_many=True, verbose=verbose, form=form))
        except CourseError as error:
            console.error(error.message, error.help)
            body = filled(ErrorBody, error)
            results.append(ErrorReply(schema="course.check/1", exit_code=error.exit_code, error=body))
    if not results:
        raise here.nothing_started()
    complete = sum(result.ok for result in results)
    pass_ = "passes" if complete == 1 else "pass"
    said = f"{complete} of {counted(len(results), 'exercise')} {pass_} every public check."
    console.line((said, "bold"))
    here.tell()
    worst = max(result.exit_code for result in results)
    return console.answer(CheckAll(exit_code=worst, results=tuple(results)))
