"""``course grade run``, ``rerun`` and ``explain``: a class graded, and graded again; one result explained."""

from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager, nullcontext
from dataclasses import replace
from functools import partial
from pathlib import Path
from statistics import quantiles
from typing import Annotated, Any

from course import extras
from course.catalog.load import Catalog
from course.catalog.models import CourseRef
from course.cli.frame.console import Console, current, meter
from course.cli.frame.here import load_catalog
from course.cli.frame.options import argument, exercise_ids, graded_ids, option, student_ids, submitted_ids
from course.cli.frame.replies import Envelope, filled
from course.cli.grade import options as opt
from course.errors import INTERRUPTED, CourseError, InternalError, NotFoundError, UsageError
from course.grading.exports.grades import grade_line
from course.grading.gradebook.records import Decision, Result
from course.grading.results.effective import MISSING, NOT_YET, Effective, ScoreChange
from course.grading.results.late import in_days
from course.grading.results.roster import read_roster
from course.grading.running import batch
from course.grading.running.folder import open_results
from course.grading.running.rerun import Change, Regraded, RerunOptions
from course.grading.running.rerun import rerun as regrade
from course.grading.running.run import GradeAll, RunOptions, Summary, Ungraded, grade_class
from course.printable import command, counted, one_line
from course.scoring.judging.submission import Terms
from course.scoring.verdict import LARGEST_SEED, format_points, in_points


class GradeSummary(Envelope, tag="course.grade-summary/1", frozen=True, kw_only=True):
    """The last line of ``grade run``: counts over the whole gradebook."""

    graded: int
    ungradable: int
    grader_error: int
    passed: int
    not_submitted: int
    already_graded: int
    isolation: dict[str, int]
    seed: int
    elapsed_s: float
    out: str
    troubled: tuple[Ungraded, ...]
    unrecognised: tuple[str, ...] = ()
    missing: tuple[str, ...] = ()
    strangers: tuple[str, ...] = ()
    unjudged: tuple[str, ...] = ()
    graders: str = ""
    edited: tuple[str, ...] = ()
    would_change: tuple[Change, ...] = ()
    unsettled: int = 0
    elsewhere: tuple[str, ...] = ()
    moved: tuple[ScoreChange, ...] = ()
    dropped: tuple[str, ...] = ()
    untimed: tuple[str, ...] = ()


def run(
    submissions: Annotated[Path, argument("SUBMISSIONS", "One folder per student.")],
    out: Annotated[Path, option("--out OUT", "Folder for the results; must be new.")],
    exercise: Annotated[list[str] | None, option("--exercise ID", "Grade these only.", exercise_ids)] = None,
    jobs: opt.Jobs = 1,
    timeout: Annotated[float, option("--timeout S", "CPU seconds per check.", min=0.1, max=60.0)] = 10.0,
    resume: Annotated[bool, option("--resume", "Finish the run that is in OUT.")] = False,
    only: Annotated[list[str] | None, option("--only STUDENT", complete=submitted_ids)] = None,
    isolation: opt.Protection = "auto",
    seed: Annotated[
        int | None,
        option("--seed", "Draw the same hidden inputs as an earlier run.", min=0, max=LARGEST_SEED),
    ] = None,
    layout: opt.Layout = "auto",
    roster: opt.RosterFile = None,
    local_cluster: opt.LocalCluster = None,
    scheduler: opt.Scheduler = None,
    yes: opt.Yes = False,
) -> int:
    """Grade a folder of submissions.

    One folder per student, or an unpacked download from Canvas, Moodle or Gradescope. The exit code is 0 if
    every submission was graded, whatever the scores; 6 if some could not be graded, and then each of these is
    listed with the reason.
    """
    console = current()
    _only_one_way(jobs, local_cluster, scheduler)
    level, at_least = opt.levels(isolation)
    terms = Terms(level, at_least, timeout)
    catalog = load_catalog()
    catalog.content.instructors()  # before a roster is read, and perhaps corrected, for nothing
    people = read_roster(roster) if roster else None
    options = RunOptions(tuple(exercise or ()), tuple(only or ()), terms, seed, resume, layout, people)
    folders = {path.name for path in submissions.glob("*/")}
    if layout == "auto" and folders and folders <= set(catalog.exercise_ids()):
        console.warn(
            f"Each folder in {submissions} is taken for a student, and all are called as exercises. If they"
            " are one student's, name the folder above them."
        )
    reached = [0, 0]

    def grading(accepted: str) -> tuple[Summary, Regraded | None]:
        mine = replace(options, accepted=accepted)
        graders = _graders(jobs, local_cluster, scheduler)
        with graders as grade, _progress(console, catalog.ref, reached) as report:
            summary = grade_class(submissions, out, catalog, mine, report, grade=grade)
            if not summary.edited:
                return summary, None
            # Who would get another score from the present graders, which a resumed run does not use.
            again = RerunOptions(dry_run=True, level=level, at_least=at_least)
            with open_results(out) as book, console.working("Grading with the edited graders, to compare"):
                return summary, regrade(book, catalog, again, grade=grade)

    try:
        summary, tried = opt.agreed(console, grading, yes=yes)
    except KeyboardInterrupt:  # what is there after Ctrl-C, and how it goes on
        done, total = reached
        words = f"all of the work of {done} of {total} students is graded" if total else "nothing was graded"
        kept = f"Interrupted: {words}. What is graded is kept, and the rest is not graded yet."
        none = "Interrupted before anything was graded; nothing was written."
        fix = "The same command with --resume goes on." if out.exists() else ""
        told = CourseError(kept if out.exists() else none, help=fix, code="interrupted")
        told.exit_code = INTERRUPTED
        raise told from None
    _show_summary(console, summary, out, options, tried)
    return summary.exit_code


def _show_edited(console: Console, summary: Summary, tried: Regraded | None, out: Path) -> None:
    if tried is None:
        return
    changes = tried.changes
    names = ", ".join(summary.edited)
    console.line((f"The graders were edited after these scores were given: {names}.", "bold"))
    would = f"{len(changes)} would change{':' if changes else '.'}"
    console.line(f"No score was changed by that. With the present graders, {would}")
    opt.show_first(console, changes, partial(opt.show_change, console))
    show_faults(console, tried, out)
    if changes:
        again = command("grade", "rerun", out)
        console.note(f"{again} gives these scores; until then the run's own graders count.")


def _only_one_way(jobs: int, local_cluster: int | None, scheduler: str | None) -> None:
    if local_cluster is not None and scheduler is not None:
        problem = "--local-cluster and --scheduler name two clusters."
        raise UsageError(problem, help="Name one of them.", code="two_clusters")
    if jobs > 1 and (local_cluster is not None or scheduler is not None):
        problem = "-j is for a run without a cluster."
        fix = "--local-cluster N says how many; a cluster elsewhere grades on all the workers it has."
        raise UsageError(problem, help=fix, code="jobs_and_cluster")


def _graders(jobs: int, local_cluster: int | None, scheduler: str | None) -> AbstractContextManager[GradeAll]:
    """The graders: processes on this machine, or a cluster."""
    if local_cluster is None and scheduler is None:
        return nullcontext(partial(batch.grade_all, graders=jobs))
    part: Any = extras.load("cluster")
    graders: AbstractContextManager[GradeAll]
    graders = part.local_cluster(local_cluster) if scheduler is None else part.remote_cluster(scheduler)
    return graders


def _show_people(console: Console, summary: Summary) -> None:
    """Missing students, and submissions without a student."""
    for listed, words in (
        (summary.missing, "handed in nothing to grade"),
        (summary.strangers, "not in the roster, or ambiguous there"),
        (summary.unrecognised, "unknown owner"),
        (summary.stay, "graded before, and kept as they were"),
        (summary.lower, "lower than before, by what was handed in now"),
        (summary.untimed, "handed in again, and on time until `course grade late --times` says when"),
    ):
        show_listed(console, listed, words)
        if listed is summary.missing and listed and not (summary.states or summary.already):
            console.note("A warm-up is graded where --exercise names it.")
        if listed is summary.strangers and listed:
            console.note(
                f"{summary.compared} A CSV file with a column student can name the folders themselves."
            )


class GradeRerun(Envelope, tag="course.grade-rerun/1", frozen=True, kw_only=True):
    """The students whose scores change, by how much, and because of which check."""

    dry_run: bool
    regraded: int
    up_to_date: int
    kept: int
    grader_error: int
    changes: tuple[Change, ...]
    graders: str = ""
    unjudged: tuple[str, ...] = ()
    rescaled: tuple[str, ...] = ()
    gone: dict[str, int]


def rerun(
    out: opt.Out,
    dry_run: Annotated[bool, option("--dry-run", "Show what would change; change nothing.")] = False,
    everything: Annotated[bool, option("--all", "Also regrade results that the same graders gave.")] = False,
    jobs: opt.Jobs = 1,
    timeout: Annotated[
        float | None, option("--timeout S", "As in the run if left out.", min=0.1, max=60.0)
    ] = None,
    isolation: opt.Isolation = "auto",
    against: opt.Against = "",
    reason: Annotated[str, option("--reason TEXT", "Kept with the regrading.")] = "",
    yes: opt.Yes = False,
) -> int:
    """Grade again, with the present graders or earlier ones.

    Regrades the results of other graders, and results that a fault of the grader left without a score. Shows
    whose score changes, by how much and because of which check. The submissions are in the gradebook; old
    results stay beside the new ones, and overrides still count.
    """
    console = current()
    level, at_least = opt.levels(isolation)
    options = RerunOptions(dry_run, everything, level, at_least, timeout, against, reason)
    catalog = load_catalog()

    def grading(accepted: str) -> Regraded:
        mine = replace(options, accepted=accepted)
        with open_results(out, writing=not dry_run) as results, console.working("Grading again"):
            return regrade(results, catalog, mine, grade=partial(batch.grade_all, graders=jobs))

    done = opt.agreed(console, grading, yes=yes)
    if not console.json:
        _show_rerun(console, done, out, dry_run=dry_run)
    code = InternalError.exit_code if done.faults else 0
    return console.answer(filled(GradeRerun, done, exit_code=code, dry_run=dry_run, grader_error=done.faults))


def _show_rerun(console: Console, done: Regraded, out: Path, *, dry_run: bool) -> None:
    for change in done.changes:
        opt.show_change(console, change)
    would = "would change" if dry_run else "changed"
    console.line((f"{done.regraded - done.faults} graded again; {len(done.changes)} {would}.", "bold"))
    if done.up_to_date:
        console.note(f"Graded by the same graders already: {done.up_to_date}; --all grades them again.")
    if without := done.kept - sum(done.gone.values()):
        console.note(f"Without a submission in the gradebook, and unchanged: {without}.")
    for name, count in done.gone.items():
        console.note(f"These graders do not have the exercise {name}; unchanged: {count}.")
    show_faults(console, done, out)
    show_unjudged(console, done.unjudged)
    for told in done.rescaled:
        console.warn(told)
    if dry_run and done.changes:
        console.note(
            "Nothing was changed. Without --dry-run the scores change, and the old results are kept."
        )


def explain(
    out: opt.Out,
    student: Annotated[str, argument("STUDENT", complete=student_ids)],
    exercise: Annotated[str, argument("EXERCISE", complete=graded_ids)],
) -> int:
    """Show everything about one result, expected values included: for the instructor, not the student."""
    catalog = load_catalog()
    with open_results(out) as results:
        results.verify()
        student = results.called(student)
        found = next(results.all(student, exercise), None)
        empty = found is None and next(results.all(), None) is None
        history = results.book.history(student, exercise)
        decisions = [one for one in results.decisions(student, exercise) if one.student]
        whose = results.named(student)
    if found is None:
        raise NotFoundError(
            f"The gradebook has no result of {student!r} for {exercise!r}.",
            help="It has none at all. Either nothing in the folders was to be graded (a warm-up is, once"
            " --exercise names it), or the run was interrupted: then the command that began it goes on with"
            " --resume."
            if empty
            else f"grades.csv in {out} lists all.",
            code="result_not_found",
        )
    console = current()
    if console.json:
        console.emit(grade_line(found, results.course))
    else:
        _show_result(catalog, whose, found, history, decisions)
    return 0


@contextmanager
def _progress(
    console: Console, course: CourseRef, reached: list[int]
) -> Iterator[Callable[[Effective, int, int], None]]:
    """Show results as they arrive: a bar on a terminal, lines elsewhere, JSON Lines with ``--json``.

    Gives a function to call with each result, students done, and all of them; ``reached`` keeps the latter.
    """
    with meter(console) if console.fancy else nullcontext() as advance:

        def report(result: Effective, done: int, total: int) -> None:
            reached[:] = done, total
            if console.json:
                console.emit_line(grade_line(result, course))
            elif advance is not None:
                advance(done, total, "graded")
            elif not console.quiet:
                verdict, about = result.verdict, f"{one_line(result.student)} {result.exercise}"
                scored = f"{verdict.score:g}/{verdict.max_score:g}"
                ending = scored if verdict.error is None else verdict.error.code
                console.line(f"{done}/{total} {about} {verdict.state} {ending}")

        yield report


def _show_summary(
    console: Console, summary: Summary, out: Path, options: RunOptions, tried: Regraded | None
) -> None:
    if console.json:
        console.emit_line(
            filled(
                GradeSummary,
                summary,
                graded=summary.states["graded"],
                ungradable=summary.states["ungradable"],
                grader_error=summary.states["grader_error"],
                already_graded=summary.already,
                isolation=dict(summary.levels),
                elapsed_s=round(summary.elapsed_s, 3),
                out=str(out),
                would_change=tried.changes if tried else (),
            )
        )
        return
    graded = summary.states["graded"]
    said = f"{graded} graded, {summary.passed} of them pass{_mark(summary)}. {summary.elapsed_s:.1f} s."
    console.line((said, "bold"))
    _show_scores(console, summary)
    for state, words in (
        ("ungradable", "could not be graded"),
        ("grader_error", "hit a fault of the grader and are marked for regrading"),
    ):
        rows = [row for row in summary.troubled if row.state == state]
        if rows:
            console.line((f"{len(rows)} {words}:", "bold"))
        _show_troubled(console, rows, "; results.jsonl has them all.")
    if any(row.code == "check_file" for row in summary.troubled):
        console.note(f"Once the file is right, {command('grade', 'rerun', out)} grades these.")
    if summary.unsettled:
        assign = command("grade", "assign", out)
        console.note(f"{assign} lists the files of those that could not be graded, and how to settle each.")
    show_elsewhere(console, summary.elsewhere, out)
    _show_people(console, summary)
    opt.show_roster(console, options.roster.file if options.roster else "", summary.moved, summary.dropped)
    show_unjudged(console, summary.unjudged)
    _show_edited(console, summary, tried, out)
    if summary.already:
        console.note(f"{summary.already} had been graded before.")
    for level, count in sorted(summary.levels.items()):
        console.note(f"{counted(count, 'submission')} ran at protection level {level}.")
    if options.terms.at_least == "L1":
        console.warn("Graded as plain processes (L1): submissions could read files and use the network.")
    files = "gradebook.sqlite, grades.csv, results.jsonl, report.html"
    console.note(f"Written: {out}/{files}. Seed {summary.seed}.")


def _show_scores(console: Console, summary: Summary) -> None:
    """How the class did in each exercise, where there are several grades."""
    rows = []
    for name, scores in summary.scores.items():
        if len(scores) > 1:
            low, middle, high = quantiles(scores, n=4, method="inclusive")
            half = f"{format_points(low)} to {format_points(high)}"
            rows.append((name, str(len(scores)), format_points(middle), half))
    if rows and not console.quiet:
        console.table(("exercise", "grades", "median", "half of them"), rows)


def _show_troubled(console: Console, rows: Sequence[Ungraded], where: str = ".") -> None:
    files: dict[tuple[str, str], list[Ungraded]] = {}
    told: list[tuple[str, Ungraded]] = []
    for row in rows:
        if row.code == "check_file":  # one line for all whom the same file kept from being graded
            files.setdefault((row.exercise, row.message), []).append(row)
        else:
            told.append((f"{one_line(row.student)} {row.exercise}", row))
    told += [
        (f"{those[0].exercise}, {counted(len(those), 'submission')}", those[0]) for those in files.values()
    ]
    opt.show_first(
        console,
        told,
        lambda one: console.item(one[0], f"{one[1].code}: {one_line(one[1].message)}"),
        where=where,
    )


def show_listed(console: Console, listed: Sequence[str], words: str) -> None:
    """How many of something there are, and the first of them; nothing if there are none."""
    if listed:
        console.line((f"{len(listed)} {words}:", "bold"))
    where = "; --json lists them all."
    opt.show_first(console, listed, lambda entry: console.line(one_line(entry), indent=2), where=where)


def show_elsewhere(console: Console, listed: Sequence[str], out: Path) -> None:
    """Graded submissions without functions that lie in another file of the student's."""
    show_listed(console, listed, "graded without functions that another file has")
    if listed:
        given = command("grade", "assign", out, "STUDENT", "FILE", "--exercise", "ID", "--reason", "TEXT")
        console.note(f"{given} grades that file, or confirms the one that was graded.")


def show_faults(console: Console, done: Regraded, out: Path) -> None:
    """What a regrading could not grade: nothing takes the place of an earlier result for that."""
    if done.troubled:
        console.line((f"{done.faults} hit a fault of the grader and keep what counted:", "bold"))
        _show_troubled(console, done.troubled)
        console.note(f"Once that is right, run {command('grade', 'rerun', out)} again.")


def _mark(summary: Summary) -> str:
    """The pass mark in words: in points for one exercise, else as a share if there is one for all."""
    if len(summary.pass_marks) == 1:
        mark, most = summary.pass_marks[0]
        return f" (pass mark: {format_points(mark)} of {format_points(most)})"
    shares = sorted({mark / most for mark, most in summary.pass_marks if most})
    if not shares:
        return ""
    highest = f" to {shares[-1]:.0%}" if f"{shares[-1]:.0%}" != f"{shares[0]:.0%}" else ""
    return f" (pass mark: {shares[0]:.0%}{highest} of the points)"


def show_unjudged(console: Console, sentences: Sequence[str]) -> None:
    """The checks whose own code broke on a submission, which is a reason to look at the check."""
    if sentences:
        console.line(("Checks whose own code broke on a submission (its result stands):", "bold"))
    opt.show_first(console, sentences, lambda sentence: console.line(sentence, indent=2))


def _show_result(
    catalog: Catalog, whose: str, found: Effective, history: list[Result], decisions: list[Decision]
) -> None:
    console, verdict, result = current(), found.verdict, found.result
    passed = "passed" if found.passed else "not passed"
    score = "none" if found.score is None else format_points(found.score)
    console.heading(f"{whose}, {found.exercise}", verdict.state)
    console.item("score", f"{score} of {format_points(found.max_score)}, {passed}", width=10)
    if found.override is not None:
        at = found.override.at
        words = f"{one_line(found.override.reason)} (set {at}; {checks_gave(found)})"
        console.item("override", words, width=10)
    if found.late is not None:
        cost = (
            f"{in_points(found.penalty)} off {opt.points(found.raw_score)}" if found.penalty else "no penalty"
        )
        console.item("late", f"{in_days(found.late)}, {cost}", width=10)
    if result.number:
        level = f" at {verdict.isolation}" if verdict.isolation else ""
        console.item("graded", f"{result.graded_at}{level}, seed {result.key.seed}", width=10)
        console.item("submission", result.key.submission_sha256, width=10)
    for older in history:
        if older.number != result.number:
            given = None if older.verdict.state == "grader_error" else older.verdict.score
            was = f"{opt.points(given)}, {older.verdict.state}"
            console.item("before", f"{older.graded_at}: {was}, grader {older.key.grader_version}", width=10)
    for note in verdict.warnings:
        console.item("note", one_line(note), width=10)
    for decision in decisions:
        before = opt.in_words(decision.before)
        words = f"{decision.at}, {decision.who}: {one_line(decision.reason)}; before: {before}"
        console.item(decision.kind, one_line(words), width=10)
    if verdict.error is not None:
        console.item("reason", f"{verdict.error.code}: {one_line(verdict.error.message)}", width=10)
        if verdict.error.help:
            console.item("advice", verdict.error.help, width=10)
    console.blank()
    known = (*catalog.exercise_ids(), *catalog.warm_up_ids())
    if verdict.checks and verdict.exercise in known:
        from course.cli.work.verdict import show_everything

        show_everything(console, catalog.exercise(verdict.exercise), verdict.checks)
    else:
        for check in verdict.checks:
            worth = f"  [{format_points(check.points)}/{in_points(check.max_points)}]"
            console.item(check.status.value, check.title, (worth, "dim"), width=10)


def checks_gave(found: Effective) -> str:
    """What the graders said of work that has a score by hand."""
    if found.verdict.state in {"ungradable", MISSING, NOT_YET}:
        return "no check ran"
    return f"the checks gave {opt.points(found.raw_score)}"
