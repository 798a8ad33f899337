"""``course grade rerun``, ``override``, ``late`` and ``similar``: the commands after a run."""

from __future__ import annotations

from contextlib import nullcontext
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Annotated

from course.cli.frame.completion import exercise_ids, graded_ids, student_ids
from course.cli.frame.console import Console, current
from course.cli.frame.here import load_catalog
from course.cli.frame.options import argument, option
from course.cli.frame.replies import filled
from course.cli.grade.options import (
    Against,
    Exercises,
    Isolation,
    Jobs,
    Out,
    Reason,
    Share,
    Yes,
    agreed,
    levels,
    moved_scores,
    show_change,
    show_roster,
)
from course.cli.grade.options import points as _points
from course.cli.grade.replies import LateOne
from course.cli.grade.running import checks_gave
from course.errors import InternalError, UsageError
from course.grading.exports.grades import grade_line, utc, write_bytes
from course.grading.gradebook.book import Gradebook
from course.grading.gradebook.records import SubmittedAt
from course.grading.results import effective as overriding
from course.grading.results.effective import Effective, Results, ScoreChange
from course.grading.results.late import (
    Worksheet,
    in_days,
    read_policy,
    read_times,
    unknown_names,
    worksheet_times,
)
from course.grading.results.merge import merged
from course.grading.results.roster import Roster, read_roster
from course.grading.running.rerun import Regraded
from course.grading.similar import Similar, page
from course.printable import counted, one_line
from course.scoring.verdict import format_points, in_points

_SHOWN = 20


def rerun(
    out: Out,
    dry_run: Annotated[bool, option("--dry-run", "Show what would change; change nothing.")] = False,
    everything: Annotated[bool, option("--all", "Also regrade results that the same graders gave.")] = False,
    jobs: Jobs = 1,
    timeout: Annotated[
        float | None, option("--timeout S", "As in the run if left out.", min=0.1, max=60.0)
    ] = None,
    isolation: Isolation = "auto",
    against: Against = "",
    reason: Annotated[str, option("--reason TEXT", "Kept with the regrading.")] = "",
    yes: Yes = False,
) -> int:
    """Grade again, with the present graders or earlier ones.

    Regrades the results of other graders, and results that a fault of the grader left without a score. Shows
    whose score changes, by how much and because of which check. The submissions are in the gradebook; old
    results stay beside the new ones, and overrides still count.
    """
    from course.cli.grade.replies import GradeRerun
    from course.grading.running.batch import grade_all
    from course.grading.running.folder import open_results
    from course.grading.running.rerun import RerunOptions
    from course.grading.running.rerun import rerun as regrade

    console = current()
    level, at_least = levels(isolation)
    options = RerunOptions(dry_run, everything, level, at_least, timeout, against, reason)
    catalog = load_catalog()

    def grading(accepted: str) -> Regraded:
        mine = replace(options, accepted=accepted)
        with open_results(out, writing=not dry_run) as results, console.working("Grading again"):
            return regrade(results, catalog, mine, grade=partial(grade_all, graders=jobs))

    done = agreed(console, grading, yes=yes)
    code = InternalError.exit_code if done.faults else 0
    if console.json:
        console.emit(filled(GradeRerun, done, exit_code=code, dry_run=dry_run, grader_error=done.faults))
    else:
        _show_rerun(console, done, dry_run=dry_run)
    return code


def _show_rerun(console: Console, done: Regraded, *, dry_run: bool) -> None:
    for change in done.changes:
        show_change(console, change)
    would = "would change" if dry_run else "changed"
    console.line((f"{done.regraded} graded again; {len(done.changes)} {would}.", "bold"))
    if done.up_to_date:
        console.note(f"Graded by the same graders already: {done.up_to_date}; --all grades them again.")
    if done.kept:
        console.note(f"Nothing to grade, and unchanged: {done.kept}.")
    if done.faults:
        console.line(f"{done.faults} failed because of a fault of the grader and are marked for regrading.")
    if dry_run and done.changes:
        console.note(
            "Nothing was changed. Without --dry-run the scores change, and the old results are kept."
        )


def override(
    out: Out,
    student: Annotated[str, argument("STUDENT", complete=student_ids)],
    exercise: Annotated[str, argument("EXERCISE", complete=graded_ids)],
    score: Annotated[float | None, option("--score X", "The points that count.")] = None,
    reason: Annotated[str, option("--reason TEXT", "Shown with the score, to the student too.")] = "",
    lift: Annotated[bool, option("--lift", "Remove the override again.")] = False,
    dry_run: Annotated[bool, option("--dry-run", "Show what would count; keep nothing.")] = False,
) -> int:
    """Set a score by hand, with a reason.

    It counts in place of the graders' score in every export and report, whatever is graded later, and no late
    penalty touches it.
    """
    from course.grading.running.folder import open_results, previewed

    if (score is None) != lift:
        raise UsageError(
            "Give either --score and --reason, or --lift.", help="See `course grade override -h`."
        )
    console = current()
    with previewed(out) if dry_run else open_results(out, writing=True) as results:
        student = results.called(student)
        if score is None:
            now = overriding.lift(results, student, exercise, reason)
        else:
            now = overriding.override(results, student, exercise, score, reason)
        course = results.course
    if console.json and now is not None:
        console.emit(grade_line(now, course))
    if now is None:
        console.line(f"{one_line(student)} {exercise}: nothing was handed in, and no score counts.")
    else:
        counts = (
            f"{_points(now.score)} of {format_points(now.max_score)} {'would count' if dry_run else 'counts'}"
        )
        console.line((f"{one_line(student)} {exercise}: {counts}; {checks_gave(now)}.", "bold"))
        if score is not None:
            console.note("The student can read the reason: it is on their page and in exports for students.")
    if dry_run:
        console.note("Nothing was changed; leave out --dry-run to change it.")
    return 0


def late(
    out: Out,
    policy: Annotated[
        Path | None, option("--policy FILE", "Late policy (TOML) to apply from now on.")
    ] = None,
    times: Annotated[
        Path | None, option("--times FILE", "CSV: student, exercise, submitted_at; or Moodle's worksheet.")
    ] = None,
    exercise: Annotated[
        str | None, option("--exercise ID", "The exercise of Moodle's worksheet.", exercise_ids)
    ] = None,
    roster: Annotated[Path | None, option("--roster FILE", "Class list, for its extension_days.")] = None,
    clear: Annotated[bool, option("--clear", "Remove the late policy.")] = False,
    reason: Reason = "",
    dry_run: Annotated[bool, option("--dry-run", "Show whose score would change; change nothing.")] = False,
) -> int:
    """Set the late policy, and show who is late.

    The policy is kept in the gradebook and applied at every export; the scores of the checks never change.
    Without options it shows the present policy.
    """
    from course.cli.grade.replies import GradeLate
    from course.grading.results.effective import Recording, recorded
    from course.grading.running.folder import open_results, previewed

    if policy is not None and clear:
        raise UsageError("--policy and --clear do not go together.", help="Give one of them.")
    console = current()
    text = read_policy(policy)[1] if policy else None
    people = read_roster(roster) if roster else None
    listed = read_times(times) if times else []
    changes = bool(policy or people or listed or clear)
    why = reason or ", ".join(str(file) for file in (policy, times, roster) if file) or "no policy"
    with previewed(out) if changes and dry_run else open_results(out, writing=changes) as opened:
        book = opened.book
        with recorded(book, "late", why) if changes else nullcontext(Recording()) as told:
            if text is not None or clear:
                book.set_meta(late_policy=text)
            dropped = _take_in(book, people)
            known = _times(Results(book), listed, exercise)
            if known:
                book.add_times(known, replace=True)
        results = Results(book)
        found = [_late_one(item) for item in results.all() if item.late is not None or item.flagged_late]
        handed_in = [item for item in results.all() if item.result.number] if results.policy else []
        unknown_time = sum(item.submitted_at is None for item in handed_in)
        unknown = _unknown(results, known)
    if console.json:
        console.emit(
            GradeLate(
                policy=results.policy is not None,
                late=tuple(found),
                time_unknown=unknown_time,
                unknown_names=tuple(unknown),
                dry_run=dry_run,
                moved=tuple(told.moved),
                dropped=tuple(dropped),
            )
        )
    else:
        _show_late(console, results, found, unknown_time, unknown)
        show_roster(console, people.file if people else "", (), dropped)
        _show_moved(console, told.moved, dry_run=dry_run)
    return 0


def _show_moved(console: Console, moved: list[ScoreChange], *, dry_run: bool) -> None:
    for line in moved_scores(moved):
        console.line(line, indent=2)
    if moved or dry_run:
        would = "would change" if dry_run else "changed"
        console.line((f"{len(moved)} {'score' if len(moved) == 1 else 'scores'} {would}.", "bold"))


def _times(
    results: Results, listed: list[SubmittedAt] | Worksheet, exercise: str | None
) -> list[SubmittedAt]:
    """The times in a list; those of a worksheet need an exercise and its deadline."""
    if not isinstance(listed, Worksheet):
        return listed
    ids = [item.id for item in results.exercises() if item.id != "quiz"]
    name = exercise or (ids[0] if len(ids) == 1 else "")
    if name not in ids:
        raise UsageError(
            f"{listed.path} is Moodle's worksheet of one assignment; which exercise is it?",
            help=f"Add --exercise, one of {', '.join(ids)}.",
            code="needs_exercise",
        )
    due = next(
        (
            one.due
            for wanted in (name, "*")
            for one in (results.policy.deadline if results.policy else ())
            if one.exercise == wanted
        ),
        None,
    )
    if due is None or due.tzinfo is None:
        raise UsageError(
            f"{listed.path} says no time zone, and there is no deadline for {name} to take it from.",
            help="Add --policy FILE.",
        )
    people = read_roster(listed.path)
    found = people.match(results.students(), results.downloads)[0]
    students = {person.moodle_key: student for student, person in found.items()}
    return worksheet_times(listed, students, name, due.tzinfo)


def _take_in(book: Gradebook, people: Roster | None) -> list[str]:
    """Keep a roster; the students who leave it."""
    dropped = []
    if people is not None:
        found = merged(Results(book), people)
        book.set_meta(roster=found.roster.dump())
        dropped = found.dropped
    return dropped


def _unknown(results: Results, times: list[SubmittedAt]) -> list[str]:
    """Names in a file of times or in the policy that the gradebook does not have."""
    students = _everybody(results)
    exercises = {item.id: item for item in results.exercises()}
    unknown = sorted({f"student {item.student}" for item in times if item.student not in students})
    unknown += sorted({f"exercise {item.exercise}" for item in times if item.exercise not in exercises})
    if results.policy is not None:
        unknown += unknown_names(results.policy, exercises, students)
    return unknown


def _everybody(results: Results) -> set[str]:
    """All names of the students in this gradebook."""
    names = set(results.students())
    people = (results.person(name) for name in results.students())
    return names | {person.student for person in people if person is not None}


def _late_one(item: Effective) -> LateOne:
    from course.cli.grade.replies import LateOne

    return filled(LateOne, item, submitted_at=utc(item.submitted_at) or None)


def _show_late(
    console: Console, results: Results, found: list[LateOne], unknown_time: int, unknown: list[str]
) -> None:
    if results.policy is None:
        console.line("No late policy is set; add one with --policy FILE.")
    for item in found:
        if item.late is None:
            words = "late, says the download, and not by how much; give its time with --times"
        else:
            cost = in_points(item.penalty) if item.penalty else "no penalty"
            words = f"{in_days(item.late)} late, {cost} ({item.submitted_at}, by {item.witness})"
        console.item(f"{one_line(item.student)} {item.exercise}", words)
    if results.policy is not None:
        count = sum(item.late is not None for item in found)
        console.line((f"{count} {'is' if count == 1 else 'are'} late.", "bold"))
        if unknown_time:
            has, counts = ("has", "it counts") if unknown_time == 1 else ("have", "they count")
            console.note(
                f"{unknown_time} {has} no trusted submission time; {counts} as on time. --times takes a"
                " list, or Moodle's grading worksheet."
            )
    for name in unknown:
        console.warn(f"The gradebook has no {name}.")


def similar(
    out: Out,
    exercise: Exercises = None,
    # The right solutions in solutions/*/accepted share 0.39 at most with the model solution, by weight; a
    # copy whose names were changed shares 1.
    share: Share = 0.6,
    output: Annotated[Path | None, option("-o --output FILE", "Page; OUT/similar.html if left out.")] = None,
) -> int:
    """Find submissions that are alike.

    Writes a page that shows them side by side. Everything happens on this machine. Names, comments and
    layout do not count, and neither does the stub. Similarity is a reason to talk with students, not a proof.
    """
    from course.cli.grade.replies import GradeSimilar, SimilarGroup, SimilarPair
    from course.grading.running.folder import open_results
    from course.grading.similar import compare

    console = current()
    catalog = load_catalog()
    with open_results(out) as results, console.working("Comparing"):
        found = compare(results, catalog, tuple(exercise or ()), at_least=share)
    target = output or out / "similar.html"
    write_bytes(target, page(found).encode("utf-8"))
    if console.json:
        pairs = tuple(
            filled(
                SimilarPair, one, first=one.first.label, second=one.second.label, share=round(one.share, 4)
            )
            for one in found.pairs
        )
        groups = tuple(filled(SimilarGroup, one, share=round(one.share, 4)) for one in found.groups)
        console.emit(filled(GradeSimilar, found, pairs=pairs, groups=groups, page=str(target)))
        return 0
    _show_similar(console, found)
    console.note(f"Side by side: {target}")
    return 0


def _show_similar(console: Console, found: Similar) -> None:
    for group in found.groups[:20]:
        names = ", ".join(map(one_line, group.members[:8]))
        names += f" and {len(group.members) - 8} more" if group.members[8:] else ""
        words = f"{group.exercise}, weakest pair {group.share:.0%}: {names}"
        console.item(f"group of {len(group.members)}", words)
    if found.groups[20:]:
        console.line(f"and {counted(len(found.groups) - 20, 'more group')}", indent=2)
    for pair in found.pairs[:20]:
        both = f"{pair.first.label} and {pair.second.label}"
        console.item(
            f"{pair.share:.0%}", f"{both}, {pair.exercise}, {counted(pair.lines, 'line')} alike", width=5
        )
    if len(found.pairs) > 20:
        console.line(f"and {counted(len(found.pairs) - 20, 'more pair')}", indent=2)
    console.line(
        (f"{counted(len(found.pairs), 'pair')} among {counted(found.compared, 'submission')}.", "bold")
    )
    if found.left_out:
        console.note(f"{counted(found.left_out, 'more pair')} not listed; raise --share.")
    if found.unreadable:
        console.note(f"{len(found.unreadable)} not compared: not Python, or over 200 kB.")
