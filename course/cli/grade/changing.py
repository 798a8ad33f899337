"""What an instructor decides after a run: ``override``, ``late``, ``assign`` and ``log``."""

import shlex
from contextlib import AbstractContextManager, nullcontext
from functools import partial
from pathlib import Path
from typing import Annotated
from zoneinfo import ZoneInfo

import msgspec

from course.cli.frame.console import Console, current
from course.cli.frame.here import load_catalog
from course.cli.frame.options import argument, exercise_ids, graded_ids, option, student_ids
from course.cli.frame.replies import Envelope, filled
from course.cli.grade import options as opt
from course.cli.grade.running import checks_gave, show_elsewhere, show_listed, show_unjudged
from course.errors import UsageError
from course.grading.exports.grades import grade_line, utc
from course.grading.gradebook.records import Decision, Run, SubmittedAt
from course.grading.results import effective as overriding
from course.grading.results.effective import Results, ScoreChange, recorded
from course.grading.results.late import (
    Worksheet,
    in_days,
    read_policy,
    read_times,
    unknown_names,
)
from course.grading.results.merge import merged
from course.grading.results.roster import read_roster
from course.grading.running import assign as assigning
from course.grading.running import batch
from course.grading.running.assign import Assigned, Unsettled
from course.grading.running.folder import open_results, previewed
from course.grading.running.run import broken_checks, unjudged
from course.printable import command, counted, one_line, quoted, some
from course.scoring.verdict import format_points, in_points

_SHOWN = 20


def override(
    out: opt.Out,
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
    if (score is None) != lift:
        problem = "Give either --score and --reason, or --lift."
        raise UsageError(problem, help="See `course grade override -h`.")
    console = current()
    with _to_change(out, dry_run=dry_run) as results:
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
        scored = f"{opt.points(now.score)} of {format_points(now.max_score)}"
        counts = f"{scored} {'would count' if dry_run else 'counts'}; {checks_gave(now)}"
        console.line((f"{one_line(student)} {exercise}: {counts}.", "bold"))
        if score is not None:
            console.note("The student can read the reason: it is on their page and in exports for students.")
    if dry_run:
        console.note("Nothing was changed; leave out --dry-run to change it.")
    return 0


class LateOne(msgspec.Struct, frozen=True, kw_only=True):
    """One result that is late, or flagged so. Seconds and points."""

    student: str
    exercise: str
    late: float | None
    penalty: float
    submitted_at: str | None
    witness: str
    flagged_late: bool


class GradeLate(Envelope, tag="course.grade-late/1", frozen=True, kw_only=True):
    """The late results under the present policy; ``time_unknown`` counts results without a trusted date."""

    policy: bool
    late: tuple[LateOne, ...]
    time_unknown: int
    unknown_names: tuple[str, ...]
    dry_run: bool = False
    moved: tuple[ScoreChange, ...] = ()
    dropped: tuple[str, ...] = ()


def late(
    out: opt.Out,
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
    reason: opt.Reason = "",
    dry_run: Annotated[bool, option("--dry-run", "Show whose score would change; change nothing.")] = False,
) -> int:
    """Set the late policy, and show who is late.

    The policy is kept in the gradebook and applied at every export; the scores of the checks never change.
    Without options it shows the present policy.
    """
    if policy is not None and clear:
        raise UsageError("--policy and --clear do not go together.", help="Give one of them.")
    console = current()
    text = read_policy(policy)[1] if policy else None
    people = read_roster(roster) if roster else None
    listed = read_times(times) if times else []
    changes = bool(policy or people or listed or clear)
    why = reason or ", ".join(one_line(str(file)) for file in (policy, times, roster) if file) or "no policy"
    with previewed(out) if changes and dry_run else open_results(out, writing=changes) as opened:
        book = opened.book
        with recorded(book, "late", why) if changes else nullcontext(list[ScoreChange]()) as moved:
            if text is not None or clear:
                book.set_meta(late_policy=text)
            dropped = []
            if people is not None:
                joined = merged(Results(book), people, lasting=True)
                book.set_meta(roster=joined.roster.dump())
                dropped = joined.dropped
            known, unused, given_more = _times(Results(book), listed, exercise)
            if known:
                book.add_times(known, replace=True)
        results = Results(book)
        handed_in = [item for item in results.all() if item.result.number]
        late_ones = [item for item in handed_in if item.late is not None or item.flagged_late]
        found = [filled(LateOne, one, submitted_at=utc(one.submitted_at) or None) for one in late_ones]
        unknown_time = sum(item.submitted_at is None for item in handed_in) if results.policy else 0
        unknown = unused + _unknown(results, known)
        zoneless = {(one.student, one.exercise) for one in known if isinstance(listed, Worksheet)}
        hanging = (
            one
            for one in handed_in
            if results.hangs_on_the_clock(one, zoneless=(one.student, one.exercise) in zoneless)
        )
        unsure = [one_line(one.student) for one in hanging]
        extended = [one_line(one.student) for one in found if (one.student, one.exercise) in given_more]
    if unsure:
        console.warn(
            f"If the clock changed in these days, an hour may cost or spare points of {some(unsure, _SHOWN)}:"
            ' with `zone = "Europe/Berlin"`, say, in the policy, a day ends at the same time of day, and a'
            " worksheet's times are read by that clock."
        )
    if extended:
        console.warn(
            f"By {times}, Moodle gave {some(extended, _SHOWN)} more time. That does not count here: write it"
            " into the policy ([[extension]]) or the roster (extension_days)."
        )
    if not console.json:
        _show_late(console, results, found, unknown_time, unknown)
        opt.show_roster(console, people.file if people else "", (), dropped)
        for line in opt.moved_scores(moved):
            console.line(line, indent=2)
        if moved or dry_run:
            would = "would change" if dry_run else "changed"
            console.line((f"{counted(len(moved), 'score')} {would}.", "bold"))
    return console.answer(
        GradeLate(
            policy=results.policy is not None,
            late=tuple(found),
            time_unknown=unknown_time,
            unknown_names=tuple(unknown),
            dry_run=dry_run,
            moved=tuple(moved),
            dropped=tuple(dropped),
        )
    )


def _times(
    results: Results, listed: list[SubmittedAt] | Worksheet, exercise: str | None
) -> tuple[list[SubmittedAt], list[str], set[tuple[str, str]]]:
    """The times in a list. Those of a worksheet need an exercise and its deadline; some rows may fit no
    student, and some students have more time by it."""
    if not isinstance(listed, Worksheet):
        named = [msgspec.structs.replace(one, student=results.called(one.student)) for one in listed]
        return named, [], set()
    ids = [item.id for item in results.exercises() if item.id != "quiz"]
    name = exercise or (ids[0] if len(ids) == 1 else "")
    if name not in ids:
        problem = f"{listed.path} is Moodle's worksheet of one assignment; which exercise is it?"
        raise UsageError(problem, help=f"Add --exercise, one of {', '.join(ids)}.", code="needs_exercise")
    deadlines = {one.exercise: one.due for one in (results.policy.deadline if results.policy else ())}
    due = deadlines.get(name, deadlines.get("*"))
    if due is None or due.tzinfo is None:
        problem = f"{listed.path} says no time zone, and there is no deadline for {name} to take it from."
        raise UsageError(problem, help="Add --policy FILE.")
    people = read_roster(listed.path)
    found = people.match(results.students(), results.downloads)[0]
    students = {person.moodle_key: student for student, person in found.items()}
    unused = [one.student for one in people.people if one.moodle_key in listed.times.keys() - students.keys()]
    told = [f"one student for the row of {student} in {listed.path}" for student in unused]
    zone = ZoneInfo(results.policy.zone) if results.policy and results.policy.zone else due.tzinfo
    given_more = {(students[key], name) for key in listed.extended & students.keys()}
    there = listed.times.keys() & students.keys()
    known = [SubmittedAt(students[key], name, "", "list", listed.at(key, zone)) for key in sorted(there)]
    return known, told, given_more


def _unknown(results: Results, times: list[SubmittedAt]) -> list[str]:
    """Names in a file of times or in the policy that the gradebook does not have."""
    students = set(results.students())
    people = (results.person(name) for name in results.students())
    students |= {person.student for person in people if person is not None}
    exercises = {item.id: item for item in results.exercises()}
    unknown = sorted({f"student {item.student}" for item in times if item.student not in students})
    unknown += sorted({f"exercise {item.exercise}" for item in times if item.exercise not in exercises})
    if results.policy is not None:
        unknown += unknown_names(results.policy, exercises, students)
    return unknown


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
        console.warn(f"The gradebook has no {one_line(name)}.")


_LISTED = 200
#: Reasons whose words are the list of files again.
_ABOUT_FILES = frozenset({"no_file", "ambiguous_files"})


class AssignedOne(msgspec.Struct, frozen=True, kw_only=True):
    """A file that became a student's submission; null scores do not count."""

    student: str
    exercise: str
    file: str
    score_before: float | None
    score_after: float | None
    state_before: str
    state_after: str


class FoundFile(msgspec.Struct, frozen=True, kw_only=True):
    """A file that may be meant for an exercise, and which of its functions it defines.

    ``kind`` says what it is, or why it cannot be read; it is empty for a .py file or a notebook.
    """

    file: str
    defines: tuple[str, ...]
    proposed: bool
    kind: str = ""


class UnsettledOne(msgspec.Struct, frozen=True, kw_only=True):
    """Work that could not be graded; ``reason`` is the code of the problem, ``message`` says it in words."""

    student: str
    exercise: str
    reason: str
    message: str
    files: tuple[FoundFile, ...]


class GradeAssign(Envelope, tag="course.grade-assign/1", frozen=True, kw_only=True):
    """The assigned files, those taken back (``lifted``), the cases that are left, and what is nobody's."""

    dry_run: bool
    assigned: tuple[AssignedOne, ...]
    unsettled: tuple[UnsettledOne, ...]
    unjudged: tuple[str, ...] = ()
    elsewhere: tuple[str, ...] = ()
    lifted: tuple[AssignedOne, ...] = ()
    unrecognised: tuple[str, ...] = ()


#: Whether there are STUDENT, FILE, --lift and --accept-names.
_WAYS = {(False,) * 4, (True, True, False, False), (True, False, True, False), (False, False, False, True)}


def assign(
    out: opt.Out,
    student: Annotated[str | None, argument("STUDENT", complete=student_ids)] = None,
    file: Annotated[
        str | None, argument("FILE", "A name from the list, or a path; a path into a zip has a slash.")
    ] = None,
    exercise: Annotated[
        str | None, option("--exercise ID", "Needed if it is not clear.", exercise_ids)
    ] = None,
    accept_names: Annotated[bool, option("--accept-names", "Accept every proposed match.")] = False,
    lift: Annotated[bool, option("--lift", "Take the student's assigned file back.")] = False,
    reason: Annotated[str, option("--reason TEXT", "Kept with each result.")] = "",
    dry_run: Annotated[bool, option("--dry-run", "Grade and show, but store nothing.")] = False,
    jobs: opt.Jobs = 1,
    isolation: opt.Isolation = "auto",
    yes: opt.Yes = False,
) -> int:
    """Assign a file to a student, and grade it.

    Without STUDENT it lists the students without a submission, the files there are for each, the functions
    that each file defines, and the proposed match. No file is renamed; who decided, when and why is kept.
    """
    if (student is not None, file is not None, lift, accept_names) not in _WAYS:
        problem = "Give STUDENT and FILE, STUDENT and --lift, --accept-names, or none of them for a list."
        raise UsageError(problem, help="See `course grade assign -h`.")
    console = current()
    done: list[Assigned] = []
    lifted: list[Assigned] = []
    listing = student is None and not accept_names
    if listing:
        with open_results(out) as results:
            left = assigning.unsettled(results)
    elif student is not None and lift:
        with _to_change(out, dry_run=dry_run) as results:
            lifted = [assigning.lift(results, student, exercise, reason)]
            left = assigning.unsettled(Results(results.book))
    else:
        reason = reason or ("the match that was proposed" if accept_names else "a trial" if dry_run else "")
        level, at_least = opt.levels(isolation)
        graders = partial(batch.grade_all, graders=jobs)
        grade = partial(assigning.assign, grade=graders, level=level, at_least=at_least)

        def graded(accepted: str) -> tuple[list[Assigned], list[Unsettled]]:
            with _to_change(out, dry_run=dry_run) as results:
                if student is not None and file is not None:
                    wanted = [assigning.named(results, student, file, exercise)]
                else:
                    wanted = [one for one in assigning.proposals(results) if exercise in {None, one.exercise}]
                with console.working("Grading"):
                    made = grade(results, load_catalog(), wanted, reason, accepted=accepted)
                return made, assigning.unsettled(results)

        done, left = opt.agreed(console, graded, yes=yes)
    with open_results(out) as results:
        unowned, each = results.unowned(), list(results.all()) if listing else []
    reply = GradeAssign(
        dry_run=dry_run,
        assigned=tuple(map(_assigned_one, done)),
        unsettled=tuple(map(_unsettled_one, left)),
        unjudged=unjudged(one for item in done if item.after for one in broken_checks(item.after)),
        elsewhere=tuple(f"{one.student} {one.exercise}: {one.elsewhere}" for one in each if one.elsewhere),
        lifted=tuple(map(_assigned_one, lifted)),
        unrecognised=tuple(unowned),
    )
    if not console.json:
        _show_assigned(console, done, lifted, dry_run=dry_run)
        show_unjudged(console, reply.unjudged)
        would = "would be left to settle" if (done or lifted) and dry_run else "to settle"
        _show_unsettled(console, left, out, would)
        _show_besides(console, reply, len({one.student for one in each if one.waiting}), out)
    return console.answer(reply)


def _to_change(out: Path, *, dry_run: bool) -> AbstractContextManager[Results]:
    """The results to change, or a copy of them that is thrown away."""
    return previewed(out) if dry_run else open_results(out, writing=True)


def _show_besides(console: Console, reply: GradeAssign, waiting: int, out: Path) -> None:
    """What else may want an instructor: work in other files, nobody's work, and students who wait."""
    show_elsewhere(console, reply.elsewhere, out)
    show_listed(console, reply.unrecognised, "of unknown owner")
    if reply.unrecognised:
        given = command("grade", "assign", out, "STUDENT", "FILE")
        console.note(f"{given}, with FILE as a path, says whose it is; a run with --resume looks again.")
    if waiting:
        console.note(f"Not graded yet: {counted(waiting, 'student')}. The run goes on with --resume.")


def _unsettled_one(item: Unsettled) -> UnsettledOne:
    files = tuple(filled(FoundFile, one, file=one.name) for one in item.found.candidates)
    return filled(UnsettledOne, item, reason=item.found.reason, files=files)


def _assigned_one(item: Assigned) -> AssignedOne:
    one, before, after = item.assignment, item.before, item.after
    was, now = (counts.verdict.state if counts else "missing" for counts in (before, after))
    scores = {"score_before": before.score if before else None, "score_after": after.score if after else None}
    states = {"state_before": was, "state_after": now}
    return filled(AssignedOne, one, file=one.name, **scores, **states)


def _show_assigned(console: Console, done: list[Assigned], lifted: list[Assigned], *, dry_run: bool) -> None:
    for item in (*done, *lifted):
        one, after = _assigned_one(item), item.after
        most = after.max_score if after and after.score is not None else None
        words = f"{one.state_before} -> {one.state_after}, {opt.points(one.score_after, most)}"
        if after is not None and after.override is not None:
            words += f" by hand ({checks_gave(after)})"
        words += f"; {'without' if item in lifted else 'from'} {quoted(one.file)}"
        console.item(f"{one_line(one.student)} {one.exercise}", words)
    if done:
        console.line((f"{len(done)} {'would be assigned' if dry_run else 'assigned and graded'}.", "bold"))
    if lifted:
        console.line((f"1 {'would be taken' if dry_run else 'taken'} back.", "bold"))


def _show_unsettled(console: Console, left: list[Unsettled], out: Path, words: str) -> None:
    for item in left[:_LISTED]:
        about = f"{one_line(item.student)} {item.exercise}"
        listed = item.found.candidates and item.found.reason in _ABOUT_FILES
        told = item.found.reason if listed else f"{item.found.reason}: {one_line(item.message)}"
        console.item(about, told)
        for one in item.found.candidates:
            defines = f"defines {', '.join(one.defines)}" if one.defines else "defines none of the functions"
            if one.kind:
                defines = f"{one.kind}; {defines}" if one.defines else one.kind
            console.item(shlex.quote(one.name), defines + ("; proposed" if one.proposed else ""), indent=4)
    if len(left) > _LISTED:
        console.line(f"and {len(left) - _LISTED} more; --json lists them all.", indent=2)
    proposed = sum(any(one.proposed for one in item.found.candidates) for item in left)
    with_match = f"; {proposed} with a match" if proposed else ""
    console.line((f"{len(left)} {words}{with_match}.", "bold"))
    if proposed:
        console.note(
            f"{command('grade', 'assign', out, '--accept-names')} accepts the matches; with --dry-run it "
            "only shows the scores they would get."
        )
    for item in [one for one in left if not any(file.proposed for file in one.found.candidates)][:1]:
        student = one_line(item.student)
        more = ("--exercise", item.exercise, "--reason", "TEXT")
        given = command("grade", "override", out, student, item.exercise, "--score", 0, "--reason", "TEXT")
        other = f"{command('grade', 'assign', out, student, 'FILE', *more)} grades another file"
        if item.exercise == "quiz":
            other = (
                "--resume grades the zip of `course submit` once it is the only one in the student's folder"
            )
        console.note(f"{given} gives a score by hand; {other}.")


class GradeLog(Envelope, tag="course.grade-log/1", frozen=True, kw_only=True):
    """Every run, and every change of a grade."""

    runs: tuple[Run, ...]
    changes: tuple[Decision, ...]


def log(
    out: opt.Out,
    student: Annotated[str | None, argument("STUDENT", complete=student_ids)] = None,
    exercise: Annotated[str | None, argument("EXERCISE", complete=graded_ids)] = None,
) -> int:
    """List every run and every change of a grade: who, when, why, and what it was before."""
    console = current()
    with open_results(out) as results:
        results.verify()
        student = None if student is None else results.called(student)
        runs = results.book.runs()
        decisions = results.decisions(student, exercise)
        known_of = [one for one in decisions if one.student]  # who left the roster may have some
        if student is not None and not known_of:
            overriding.must_have(results, student)
        known = [item.id for item in results.exercises()]
        if exercise is not None and not known_of and exercise not in known:
            raise overriding.no_exercise(exercise, known)
    if console.json:
        return console.answer(GradeLog(runs=tuple(runs), changes=tuple(decisions)))
    for run in runs:
        graders = str(run.options.get("snapshot", ""))[:12] or "not kept"
        why = f", {run.options['reason']}" if run.options.get("reason") else ""
        words = f"{run.started_at}, {run.options.get('who', 'name not kept')}, graders {graders}{why}"
        console.item(f"{run.kind} {run.number}", one_line(words), width=10)
    for decision in decisions:
        about = one_line(" ".join(part for part in (decision.student, decision.exercise) if part))
        words = f"{decision.at}, {decision.who}, {about or 'the class'}"
        words += f": {decision.reason}" if decision.reason else ""
        console.item(decision.kind, one_line(words), width=10)
        before, after = (opt.in_words(one, student, exercise) for one in (decision.before, decision.after))
        if decision.kind == "lift":  # what is kept has no score: the graders' counts, whatever it is then
            after = "the graders' score"
        if before != after:
            console.line(f"{before} -> {after}", indent=12)
    return 0
