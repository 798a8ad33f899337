"""``course grade``: what an instructor does with a class. Needs a checkout."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from course.cli.completion import exercise_ids
from course.cli.console import Console, current

if TYPE_CHECKING:
    from collections.abc import Callable

    from course.catalog.load import Catalog
    from course.grading.gradebook import Result
    from course.grading.run import RunOptions, Summary

__all__ = ["app", "explain", "run"]

_HELP = {"help_option_names": ["-h", "--help"]}
_MOST_TROUBLED = 20

app = typer.Typer(
    help="Grade a class.", no_args_is_help=True, pretty_exceptions_enable=False, context_settings=_HELP
)


@app.callback()
def _group() -> None:
    """Grade a class: hidden checks, protected workers, one gradebook."""


@app.command("run", epilog="Example: course grade run submissions --exercise integrators --out grades -j 2")
def run(
    submissions: Annotated[Path, typer.Argument(metavar="SUBMISSIONS", help="One folder per student.")],
    out: Annotated[Path, typer.Option("--out", metavar="OUT", help="Folder for the results; must be new.")],
    exercise: Annotated[
        list[str] | None,
        typer.Option("--exercise", metavar="ID", help="Grade these only.", autocompletion=exercise_ids),
    ] = None,
    jobs: Annotated[int, typer.Option("-j", min=1, max=256, help="Grader processes.")] = 1,
    timeout: Annotated[
        float, typer.Option("--timeout", metavar="S", min=0.1, max=60.0, help="Wall seconds per check.")
    ] = 10.0,
    resume: Annotated[bool, typer.Option("--resume", help="Finish the run that is in OUT.")] = False,
    only: Annotated[list[str] | None, typer.Option("--only", metavar="STUDENT")] = None,
    isolation: Annotated[
        str,
        typer.Option(
            "--isolation",
            metavar="auto|strict|process",
            help="auto: the best level, L2 at least. strict: L3. process: L1, no protection of files.",
        ),
    ] = "auto",
    seed: Annotated[
        int | None, typer.Option("--seed", min=0, help="Draw hidden inputs as an earlier run did.")
    ] = None,
) -> int:
    """Grade a folder of submissions.

    The exit code is 0 when every submission was graded, whatever the scores; 6 when some could not be, and
    then each is listed with its reason.
    """
    from course.cli.here import load_catalog
    from course.grading.run import RunOptions, grade_class

    console = current()
    level, at_least = _levels(isolation)
    options = RunOptions(
        tuple(exercise or ()), tuple(only or ()), jobs, level, at_least, timeout, seed, resume
    )
    catalog = load_catalog()
    with _progress(console) as report:
        summary = grade_class(submissions, out, catalog, options, report)
    _show_summary(console, summary, out, options)
    return summary.exit_code


@app.command("explain", epilog="Example: course grade explain grades ada integrators")
def explain(
    out: Annotated[Path, typer.Argument(metavar="OUT", help="Folder of a grading run.")],
    student: Annotated[str, typer.Argument(metavar="STUDENT")],
    exercise: Annotated[str, typer.Argument(metavar="EXERCISE", autocompletion=exercise_ids)],
) -> int:
    """Show everything about one result, expected values included: for the instructor, not the student."""
    from course.cli.here import load_catalog
    from course.errors import NotFoundError
    from course.grading.exports.lines import CourseRef, grade_line
    from course.grading.gradebook import Gradebook

    catalog = load_catalog()
    with Gradebook(out / "gradebook.sqlite") as book:
        found = next(iter(book.results(student, exercise)), None)
    if found is None:
        raise NotFoundError(
            f"The gradebook has no result of {student!r} for {exercise!r}.",
            help=f"grades.csv in {out} lists all.",
            code="result_not_found",
        )
    console = current()
    if console.json:
        console.emit(grade_line(found, CourseRef(catalog.course_id, catalog.version)))
    else:
        _show_result(console, catalog, found)
    return 0


def _levels(isolation: str) -> tuple[str | None, str]:
    """The level to insist on, if any, and the weakest one to accept."""
    from course.errors import UsageError

    choices = {"auto": (None, "L2"), "strict": ("L3", "L3"), "process": ("L1", "L1")}
    if isolation not in choices:
        raise UsageError(f"--isolation is {isolation!r}.", help="It takes auto, strict or process.")
    return choices[isolation]


class _progress:  # noqa: N801 - used as a function
    """Shows results as they come: a bar on a terminal, lines elsewhere, JSON Lines with ``--json``."""

    def __init__(self, console: Console) -> None:
        self._console = console
        self._bar: Any = None

    def __enter__(self) -> Callable[[Result, int, int], None]:
        console = self._console
        if console.json:
            return self._json
        if console.quiet:
            return lambda *_: None
        if not console.fancy:
            return self._line
        from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

        columns = (
            TextColumn("{task.description}"),
            BarColumn(None),
            MofNCompleteColumn(),
            TimeRemainingColumn(),
        )
        self._bar = Progress(*columns, console=console.rich(), transient=True)
        self._task = self._bar.add_task("Grading", total=None)
        self._bar.start()
        return self._advance

    def __exit__(self, *_: object) -> None:
        if self._bar is not None:
            self._bar.stop()

    def _advance(self, _result: Result, done: int, total: int) -> None:
        self._bar.update(self._task, completed=done, total=total)

    def _line(self, result: Result, done: int, total: int) -> None:
        verdict = result.verdict
        ending = f"{verdict.score:g}/{verdict.max_score:g}" if verdict.error is None else verdict.error.code
        self._console.line(
            f"{done}/{total} {result.key.student} {result.key.exercise} {verdict.state} {ending}"
        )

    def _json(self, result: Result, _done: int, _total: int) -> None:
        from course.grading.exports.lines import CourseRef, grade_line

        self._console.emit_line(grade_line(result, _course(CourseRef)))


def _course(kind: Any) -> Any:
    from course.cli.here import load_catalog

    catalog = load_catalog()
    return kind(catalog.course_id, catalog.version)


def _show_summary(console: Console, summary: Summary, out: Path, options: RunOptions) -> None:
    if console.json:
        from course.cli.grade_schemas import GradeSummary

        console.emit_line(
            GradeSummary(
                ok=summary.exit_code == 0,
                exit_code=summary.exit_code,
                graded=summary.states["graded"],
                ungradable=summary.states["ungradable"],
                grader_error=summary.states["grader_error"],
                passed=summary.passed,
                not_submitted=summary.not_submitted,
                already_graded=summary.already,
                isolation=dict(summary.levels),
                seed=summary.seed,
                elapsed_s=round(summary.elapsed_s, 3),
                out=str(out),
                troubled=tuple(summary.troubled),
            )
        )
        return
    graded = summary.states["graded"]
    console.line((f"{graded} graded, {summary.passed} of them pass. {summary.elapsed_s:.1f} s.", "bold"))
    for state, words in (
        ("ungradable", "could not be graded"),
        ("grader_error", "hit a fault of the grader and are marked for regrading"),
    ):
        rows = [row for row in summary.troubled if row.state == state]
        if rows:
            console.line((f"{len(rows)} {words}:", "bold"))
        for row in rows[:_MOST_TROUBLED]:
            console.item(f"{row.student} {row.exercise}", f"{row.code}: {row.message}")
        if len(rows) > _MOST_TROUBLED:
            console.line(f"and {len(rows) - _MOST_TROUBLED} more; results.jsonl has them all.", indent=2)
    if summary.already:
        console.note(f"{summary.already} had been graded before.")
    levels = ", ".join(f"{level} for {count}" for level, count in sorted(summary.levels.items()))
    if levels:
        console.note(f"Protection: {levels}.")
    if options.at_least == "L1":
        console.warn("Graded as plain processes (L1): submissions could read files and use the network.")
    console.note(f"Written: {out}/gradebook.sqlite, grades.csv, results.jsonl. Seed {summary.seed}.")


def _show_result(console: Console, catalog: Catalog, result: Result) -> None:
    from course.cli.verdicts import show_everything

    verdict = result.verdict
    passed = "passed" if verdict.passed else "not passed"
    console.heading(f"{result.key.student}, {result.key.exercise}", verdict.state)
    console.item("score", f"{verdict.score:g} of {verdict.max_score:g}, {passed}", width=10)
    level = f" at {verdict.isolation}" if verdict.isolation else ""
    console.item("graded", f"{result.graded_at}{level}, seed {result.key.seed}", width=10)
    console.item("submission", result.key.submission_sha256, width=10)
    if verdict.error is not None:
        console.item("reason", f"{verdict.error.code}: {verdict.error.message}", width=10)
        console.item("advice", verdict.error.help, width=10)
    console.blank()
    if verdict.checks:
        show_everything(console, catalog.exercise(verdict.exercise), verdict.checks)
