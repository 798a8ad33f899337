"""``course check`` and ``report``: the student's code run, as in a grading run, and what it gives.

A check gives a verdict; a report shows results on public data in words, tables and figures.
"""

from __future__ import annotations

import re
import shlex
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import msgspec

from course.catalog.models import CourseRef
from course.cli.frame.console import Console, current
from course.cli.frame.here import Here, named, write_told
from course.cli.frame.options import ExerciseName, Verbose, check_ids, choice_of, option
from course.cli.frame.replies import Envelope, ErrorBody, ErrorReply, NextStep, WrittenFile, filled
from course.cli.home.advice import after_report, next_step
from course.cli.work.chosen import StudentWork, asked_for, chosen_work, worked_on
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
from course.scoring.verdict import CheckResult, Verdict

if TYPE_CHECKING:
    from course.figures.described import Curve
    from course.scoring.failures import Report, Section


class CurveReply(msgspec.Struct, frozen=True):
    """Two curves that a failed check compared over time, the student's and the right one; at most 200 points.

    Attributes:
        check: its id.
        quantity, units: of both curves.
        right_is: what the right one is: "right", or the method that the step is named for.
        parts_at: when the student's curve leaves the right one, in s.
        description: the same as a sentence.
        t: times, in s.
        yours, right: values at these times.
    """

    check: str
    quantity: str
    units: str
    right_is: str
    parts_at: float
    description: str
    t: tuple[float, ...]
    yours: tuple[Any, ...]
    right: tuple[float, ...]


class Check(Envelope, tag="course.check/1", frozen=True, kw_only=True):
    """The verdict on one exercise. ``ok`` is "every check passes", ``passed`` is "reaches the pass mark".

    Attributes:
        printed: the file's output while it was loaded; output during a check is in that check's ``stdout``.
        curves: of failed checks that compared a motion along time, in the order of the tasks.
    """

    course: CourseRef
    exercise: str
    scope: str
    score: float
    max_score: float
    passed: bool
    checks: tuple[CheckResult, ...]
    next: NextStep | None = None
    warnings: tuple[str, ...] = ()
    printed: str = ""
    curves: tuple[CurveReply, ...] = ()


#: The two outcomes of a check. JSON tells them apart by their fields, msgspec does not.
CheckOrError = Annotated[
    Any,
    msgspec.Meta(extra_json_schema={"anyOf": [{"$ref": "#/$defs/Check"}, {"$ref": "#/$defs/ErrorReply"}]}),
]


class CheckAll(Envelope, tag="course.check-all/1", frozen=True, kw_only=True):
    refers_to = (Check,)

    results: tuple[CheckOrError, ...]


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


# ---
# ``course report``: the student's own code on public data, in words, tables and figures.


class SectionReply(msgspec.Struct, frozen=True, kw_only=True):
    """One part of a report. ``figure`` is its file, ``description`` the figure in words."""

    title: str
    text: str
    columns: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    figure: WrittenFile | None
    description: str


class ReportReply(Envelope, tag="course.report/1", frozen=True, kw_only=True):
    course: CourseRef
    exercise: str
    title: str
    sections: tuple[SectionReply, ...]
    bag: str | None


def report(
    exercise: ExerciseName = None,
    out: Annotated[
        Path | None, option("--out -o DIR", "Where figures go; default: report/ beside your file.")
    ] = None,
    bag: Annotated[
        Path | None, option("--bag DIR", "Write the sensor streams as a ROS 2 bag (extra ros).")
    ] = None,
) -> int:
    """Show what your code does, with figures.

    Runs your functions on public data, as the checks do, and draws the results. Parts whose functions are not
    written yet say so.
    """
    from course.scoring.judging.session import report_of

    console, here = current(), Here.load()
    work = chosen_work(here, *asked_for(here, exercise))
    chosen = work.exercise
    report_source_file(console, here, work)
    with console.working(f"Running {work.name}"):
        made = report_of(chosen, here.catalog, work.submission)
    folder = here.workspace.path(chosen.place, "report") if out is None else named(out)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        problem = f"The folder {folder} cannot be made ({error.strerror or error})."
        raise UsageError(problem, help="Name another one with --out.", code="not_writable") from error
    console.heading(made.title, chosen.id)
    names = (re.sub(r"[^a-z0-9]+", "-", one.title.lower()).strip("-")[:40] for one in made.sections)
    files = (folder / f"{number}-{name or 'section'}.png" for number, name in enumerate(names, 1))
    sections = tuple(_shown(console, *both) for both in zip(made.sections, files, strict=True))
    written = _write_bag(console, made, bag) if bag is not None else None
    console.next(after_report(here, chosen))
    named_so = {"course": here.course, "exercise": chosen.id}
    return here.answer(filled(ReportReply, made, **named_so, sections=sections, bag=written))


def _shown(console: Console, section: Section, path: Path) -> SectionReply:
    """Print one section, draw its figure, and give both for scripts."""
    console.blank()
    console.line((section.title, "bold"))
    for paragraph in section.text.split("\n\n"):
        if not paragraph.lstrip().startswith("- "):
            console.line(" ".join(paragraph.split()))
            continue
        for item in paragraph.strip().split("\n"):
            console.line(item.strip(), indent=2)
    if section.rows:
        console.table_or_facts(section.columns, section.rows)
    if (plot := section.plot) is None:
        return filled(SectionReply, section, figure=None, description="")
    from course.figures.plots import draw, render

    with console.working("Drawing"):
        picture = render(plot)
    console.figure(lambda: draw(plot))
    if plot.description:
        console.line(("Figure: " + plot.description, "dim"))
    # An unchanged figure needs no copy of the old one.
    path.unlink(missing_ok=True)
    figure = write_told(path, picture, why="report")
    return filled(SectionReply, section, figure=figure, description=plot.description)


def _write_bag(console: Console, made: Report, bag: Path) -> str:
    if not made.streams:
        problem = "This report has no sensor streams to write."
        fix = "Its sensors are not written yet, or the exercise has none."
        raise UsageError(problem, help=fix, code="no_streams")
    from course.simulations.bags import KINDS, VIEW, streams_from, write_bag

    path, streams = named(bag), streams_from(made.streams)
    write_bag(path, streams)
    kinds = {kind: name for name, kind in KINDS.items()}
    counts = [f"{len(stream.t)} of {kinds[type(stream)]}" for stream in streams]
    console.blank()
    console.line(f"Wrote {path}: messages {', '.join(counts)}.")
    console.note(f"With ROS 2: ros2 bag play {shlex.quote(str(path))}")
    console.note(f"Beside it: rviz2 -d {shlex.quote(str(path / VIEW))} --ros-args -p use_sim_time:=true")
    return str(path)
