"""``course grade assign``, ``log`` and ``salvage``: misnamed files, the journal, a damaged gradebook."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Annotated

from course.cli.frame.completion import exercise_ids, graded_ids, student_ids
from course.cli.frame.console import Console, current
from course.cli.frame.here import load_catalog
from course.cli.frame.options import argument, option
from course.cli.frame.replies import filled
from course.cli.grade.options import Isolation, Jobs, Out, Yes, agreed, in_words, levels
from course.cli.grade.replies import AssignedOne, UnsettledOne
from course.errors import UsageError
from course.grading.gradebook.book import Gradebook
from course.grading.gradebook.records import Decision
from course.grading.gradebook.salvage import Salvaged, back_up
from course.grading.gradebook.salvage import salvage as rescue
from course.grading.results.effective import Results
from course.grading.running.assign import Assigned, Unsettled
from course.printable import command, counted, one_line
from course.scoring.verdict import format_points

_SHOWN = 200
#: Reasons whose words are the list of files again.
_ABOUT_FILES = frozenset({"no_file", "ambiguous_files"})


def assign(
    out: Out,
    student: Annotated[str | None, argument("STUDENT", complete=student_ids)] = None,
    file: Annotated[
        str | None, argument("FILE", "A name from the list, or a path; a path into a zip has a slash.")
    ] = None,
    exercise: Annotated[
        str | None, option("--exercise ID", "Needed if it is not clear.", exercise_ids)
    ] = None,
    accept_names: Annotated[bool, option("--accept-names", "Accept every proposed match.")] = False,
    reason: Annotated[str, option("--reason TEXT", "Kept with each result.")] = "",
    dry_run: Annotated[bool, option("--dry-run", "Grade and show, but store nothing.")] = False,
    jobs: Jobs = 1,
    isolation: Isolation = "auto",
    yes: Yes = False,
) -> int:
    """Assign a file to a student, and grade it.

    Without STUDENT it lists the students without a submission, the files there are for each, the functions
    that each file defines, and the proposed match. No file is renamed; who decided, when and why is kept.
    """
    from course.cli.grade.replies import GradeAssign
    from course.grading.running import assign as assigning
    from course.grading.running.batch import grade_all
    from course.grading.running.folder import open_results, previewed

    if (student is None) != (file is None) or (student is not None and accept_names):
        raise UsageError(
            "Give STUDENT and FILE, or --accept-names, or neither for a list.",
            help="See `course grade assign -h`.",
        )
    console = current()
    done: list[Assigned] = []
    waiting = 0
    if student is None and not accept_names:
        with open_results(out) as results:
            left, waiting = assigning.unsettled(results), len(results.book.waiting())
    else:
        level, at_least = levels(isolation)
        reason = reason or ("the match that was proposed" if accept_names else "")
        grade = partial(grade_all, graders=jobs)

        def assigned(accepted: str) -> tuple[list[Assigned], list[Unsettled]]:
            with previewed(out) if dry_run else open_results(out, writing=True) as results:
                if student is not None and file is not None:
                    wanted = [assigning.named(results, student, file, exercise)]
                else:
                    wanted = [one for one in assigning.proposals(results) if exercise in {None, one.exercise}]
                with console.working("Grading"):
                    done = assigning.assign(
                        results, load_catalog(), wanted, reason, grade=grade, level=level, at_least=at_least,
                        accepted=accepted,
                    )  # fmt: skip
                return done, assigning.unsettled(results)

        done, left = agreed(console, assigned, yes=yes)
    if console.json:
        shown = tuple(map(_assigned_one, done)), tuple(map(_unsettled_one, left))
        console.emit(GradeAssign(dry_run=dry_run, assigned=shown[0], unsettled=shown[1]))
    else:
        _show_assigned(console, done, dry_run=dry_run)
        _show_unsettled(console, left, out)
        if waiting:
            console.note(f"Not graded yet: {counted(waiting, 'student')}. The run goes on with --resume.")
    return 0


def _assigned_one(item: Assigned) -> AssignedOne:
    from course.cli.grade.replies import AssignedOne

    one, before = item.assignment, item.before
    return filled(
        AssignedOne,
        one,
        file=one.name,
        score_before=before.score if before else None,
        score_after=item.after.score,
        state_before=before.verdict.state if before else "missing",
        state_after=item.after.verdict.state,
    )


def _unsettled_one(item: Unsettled) -> UnsettledOne:
    from course.cli.grade.replies import FoundFile, UnsettledOne

    files = tuple(filled(FoundFile, one, file=one.name) for one in item.found.candidates)
    return filled(UnsettledOne, item, reason=item.found.reason, files=files)


def _show_assigned(console: Console, done: list[Assigned], *, dry_run: bool) -> None:
    for item in done:
        one, after = item.assignment, item.after
        was = item.before.verdict.state if item.before else "missing"
        points = "no score" if after.score is None else format_points(after.score)
        most = format_points(after.max_score)
        words = f"{was} -> {after.verdict.state}, {points} of {most}; from {one_line(one.name)}"
        console.item(f"{one_line(one.student)} {one.exercise}", words)
    if done:
        console.line((f"{len(done)} {'would be assigned' if dry_run else 'assigned and graded'}.", "bold"))


def _show_unsettled(console: Console, left: list[Unsettled], out: Path) -> None:
    for item in left[:_SHOWN]:
        about = f"{one_line(item.student)} {item.exercise}"
        listed = item.found.candidates and item.found.reason in _ABOUT_FILES
        told = item.found.reason if listed else f"{item.found.reason}: {one_line(item.message)}"
        console.item(about, told)
        for one in item.found.candidates:
            defines = f"defines {', '.join(one.defines)}" if one.defines else "defines none of the functions"
            if one.kind:
                defines = f"{one.kind}; {defines}" if one.defines else one.kind
            console.item(one.name, defines + ("; proposed" if one.proposed else ""), indent=4)
    if len(left) > _SHOWN:
        console.line(f"and {len(left) - _SHOWN} more; --json lists them all.", indent=2)
    proposed = sum(any(one.proposed for one in item.found.candidates) for item in left)
    with_match = f"; {proposed} with a match" if proposed else ""
    console.line((f"{len(left)} to settle{with_match}.", "bold"))
    if proposed:
        console.note(
            f"{command('grade', 'assign', out, '--accept-names')} accepts the matches; with --dry-run it "
            "only shows the scores they would get."
        )
    for item in [one for one in left if not any(file.proposed for file in one.found.candidates)][:1]:
        student = one_line(item.student)
        given = command("grade", "override", out, student, item.exercise, "--score", 0, "--reason", "TEXT")
        other = command(
            "grade", "assign", out, student, "FILE", "--exercise", item.exercise, "--reason", "TEXT"
        )
        console.note(f"{given} gives a score by hand; {other} grades another file.")


def log(
    out: Out,
    student: Annotated[str | None, argument("STUDENT", complete=student_ids)] = None,
    exercise: Annotated[str | None, argument("EXERCISE", complete=graded_ids)] = None,
) -> int:
    """List every run and every change of a grade: who, when, why, and what it was before."""
    from course.cli.grade.replies import GradeLog
    from course.grading.running.folder import open_results

    console = current()
    with open_results(out) as results:
        results.verify()
        student = None if student is None else results.called(student)
        runs = results.book.runs()
        decisions = results.decisions(student, exercise)
    if console.json:
        console.emit(GradeLog(runs=tuple(runs), changes=tuple(decisions)))
        return 0
    for run in runs:
        graders = str(run.options.get("snapshot", ""))[:12] or "not kept"
        why = f", {run.options['reason']}" if run.options.get("reason") else ""
        words = f"{run.started_at}, {run.options.get('who', 'name not kept')}, graders {graders}{why}"
        console.item(f"{run.kind} {run.number}", words, width=10)
    for decision in decisions:
        about = one_line(" ".join(part for part in (decision.student, decision.exercise) if part))
        words = f"{decision.at}, {decision.who}, {about or 'the class'}: {one_line(decision.reason)}"
        console.item(decision.kind, words, width=10)
        before, after = in_words(decision.before), in_words(decision.after)
        if decision.kind == "lift":  # what is kept has no score: the graders' counts, whatever it is then
            after = "the graders' score"
        if before != after:
            console.line(f"{before} -> {after}", indent=12)
    return 0


def salvage(
    out: Out,
    to: Annotated[Path, option("--to NEW", "Folder for the intact rows; must be new.")],
    dry_run: Annotated[bool, option("--dry-run", "Report what can be recovered; write nothing.")] = False,
) -> int:
    """Recover the intact parts of a damaged gradebook and its backups.

    Everything goes into a new folder; the damaged file and its backups stay unchanged. The exit code is 0
    if nothing is known to be lost, else 6 with a list; `course grade run --resume` grades what is missing.
    """
    from course.cli.grade.replies import GradeSalvage
    from course.grading.running.folder import export_all
    from course.isolation.launch import private_folder, remove_tree

    console = current()
    if to.exists():
        raise UsageError(
            f"{to} exists already; nothing was changed.", help="Name a new folder.", code="out_exists"
        )
    folder = private_folder() if dry_run else to
    folder.mkdir(parents=True, exist_ok=True)
    try:
        path = folder / "gradebook.sqlite"
        told = rescue(out / path.name, path)
        with Gradebook(path, writing=True) as book:
            lost = "; ".join(told.lost) or "nothing known to be lost"
            book.note(Decision("", "", "salvage", "", "", f"from {out}", "", lost))
            if not dry_run:
                export_all(folder, Results(book))
        if not dry_run:
            back_up(path)
    finally:
        if dry_run:
            remove_tree(folder)
        elif not any(folder.iterdir()):
            folder.rmdir()
    code = 6 if told.lost else 0
    if console.json:
        console.emit(filled(GradeSalvage, told, exit_code=code, dry_run=dry_run, out=str(to)))
        return code
    _show_salvaged(console, told, to, dry_run=dry_run)
    return code


def _show_salvaged(console: Console, told: Salvaged, to: Path, *, dry_run: bool) -> None:
    from course.grading.running.folder import open_results

    for name in ("results", "submissions", "overrides", "journal", "snapshots"):
        backed = told.from_backup[name]
        words = f"{told.rows[name]}" + (f", {backed} of them from a backup" if backed else "")
        console.item(name, words, width=12)
    for entry in told.lost[:_SHOWN]:
        console.line(f"lost: {one_line(entry)}")
    console.line(
        (f"{len(told.lost)} known to be lost." if told.lost else "Nothing is known to be lost.", "bold")
    )
    if not dry_run:
        with open_results(to) as results:
            folder = results.book.run_options().get("folder", "SUBMISSIONS")
        rest = command("grade", "run", folder, "--out", to, "--resume")
        console.note(f"Written: {to}. {rest} grades what is missing.")
