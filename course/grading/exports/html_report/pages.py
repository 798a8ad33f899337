"""The report as pages: of the class, of the list of students, and of each student.

Text is escaped in them, and characters that affect other text are spelled out.
"""

import base64
import contextlib
import hashlib
import itertools
import math
import os
import re
import sys
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache, lru_cache
from pathlib import Path
from statistics import mean, median
from typing import Any, Final
from urllib.parse import quote

import jinja2
import msgspec
from jinja2.bccache import Bucket
from markupsafe import Markup, escape

from course.grading.exports.grades import csv_bytes, number, write_bytes
from course.grading.exports.html_report.tally import CheckTally, ExerciseTally, Tally
from course.grading.exports.selection import (
    ExportOptions,
    Written,
    begins,
    checks_for_student,
    problem_for_student,
    refuse_to_replace,
    select,
)
from course.grading.gradebook.records import GradedExercise
from course.grading.quiz import EXERCISE_ID as QUIZ
from course.grading.results.effective import Effective, Results
from course.grading.results.late import in_days
from course.grading.results.roster import Person
from course.printable import counted, one_line
from course.scoring.verdict import (
    CheckResult,
    Problem,
    Status,
    Visibility,
    format_points,
    in_points,
    numbers_of,
)

# ---
# The charts' content: shares, times and scores in words, and counted for histograms.


_FEW = 10  # scores up to here get a bar each, if all are whole
#: Upper ends of the bars for times, in s: two a decade, as times spread over many.
_STEPS = (0.001, 0.003, 0.01, 0.03, 0.1, 0.3, 1.0, 3.0, 10.0, 30.0, 100.0)


@dataclass(frozen=True)
class Bin:
    """One bar: its meaning in words, the number under its left edge (or its middle), and its count."""

    words: str
    label: str
    count: int


def percent(part: float, whole: float) -> str:
    """A share in words; "100 %" only of everything, "0 %" only of nothing."""
    if whole <= 0:
        return "–"
    share = part / whole
    if 0 < share < 0.01:
        return "under 1 %"
    if 0.99 < share < 1:
        return "over 99 %"
    return f"{share:.0%}".replace("%", " %")


def duration(seconds: float) -> str:
    """A time as a person reads it."""
    if seconds < 1:
        return f"{seconds * 1e3:.{0 if seconds >= 0.01 else 1}f} ms"
    return f"{seconds:.3g} s"


def score_bins(scores: Sequence[float], most: float) -> tuple[list[Bin], bool]:
    """Scores counted for a histogram; and whether each bar stands for one score instead of a tenth."""
    whole = most == int(most) and 0 < most <= _FEW and all(score == int(score) for score in scores)
    per_bar = 1.0 if whole else most / 10
    counts = [0] * (int(most) + 1 if whole else 10)
    for score in scores:
        at = int(score / per_bar + 1e-9) if per_bar else 0
        counts[min(max(at, 0), len(counts) - 1)] += 1
    if whole:
        return [Bin(f"{at} points", str(at), count) for at, count in enumerate(counts)], True
    words = [f"{10 * at} to under {10 * at + 10} %" for at in range(9)] + ["90 to 100 %"]
    return [Bin(words[at], str(10 * at), count) for at, count in enumerate(counts)], False


def duration_bins(seconds: Sequence[float]) -> list[Bin]:
    """Times counted for a histogram; empty bars at both ends are left out."""
    counts = [0] * (len(_STEPS) + 1)
    for value in seconds:
        counts[sum(value >= step for step in _STEPS)] += 1
    used = [at for at, count in enumerate(counts) if count]
    bins = []
    for at in range(used[0], used[-1] + 1) if used else ():
        low = duration(_STEPS[at - 1]) if at else "0"
        high = duration(_STEPS[at]) if at < len(_STEPS) else ""
        words = f"{low} to under {high}" if high else f"{low} and more"
        bins.append(Bin(words, low.replace(".0", ""), counts[at]))
    return bins


def mark_of(share: float, most: float, *, each: bool) -> float:
    """Where the pass mark is among the bars of ``score_bins``."""
    return float(math.ceil(share * most - 1e-9)) if each else share * 10


# ---
# Times in words.


def when(iso: str) -> str:
    """A UTC time as a person reads it: "2026-12-01 23:59 UTC"."""
    return f"{iso[:10]} {iso[11:16]} UTC" if len(iso) >= 16 else iso


#: The beginning of every page; a file that begins otherwise is not ours to replace.
MARKER: Final = "<!DOCTYPE html>\n<!-- course grade -->\n"
_TEMPLATES = Path(__file__).with_name("templates")
#: Searched for after escaping, when no character of HTML is left.
_CODE = re.compile(r"`([^`\n]{1,200})`")
#: Characters of a name that are shown: a folder may be called anything.
_LONGEST_NAME = 120


def render(template: str, **words: Any) -> str:
    """A page.

    Args:
        template: its name, without the end ``.html.j2``.
        words: what it shows. All text is literal: it contains no markup, and cannot hide or reorder other
            text.
    """
    return _environment().get_template(f"{template}.html.j2").render(words)


def macro(template: str, name: str, *arguments: Any, **more: Any) -> Markup:
    found = getattr(_environment().get_template(f"{template}.html.j2").module, name)
    return Markup(found(*arguments, **more))


def shortened(value: str, longest: int) -> str:
    """The text, shortened if it is too long to read."""
    return value if len(value) <= longest else value[:longest].rstrip() + "…"


@cache
def script() -> str:
    """The script that sorts and filters tables; the page is complete without it."""
    return (_TEMPLATES / "tables.js").read_text("utf-8")


# -- inside ----------------------------------------------------------------------------------------------


class _Compiled(jinja2.FileSystemBytecodeCache):
    """The compiled templates, kept beside Python's own compiled files: compiling takes longer than a page."""

    def get_source_checksum(self, source: str) -> str:
        """Of the template and of this file, whose settings it is compiled with."""
        return super().get_source_checksum(source + Path(__file__).read_text("utf-8"))

    def load_bytecode(self, bucket: Bucket) -> None:
        with contextlib.suppress(OSError):
            super().load_bytecode(bucket)

    def dump_bytecode(self, bucket: Bucket) -> None:
        if not sys.dont_write_bytecode:
            with contextlib.suppress(OSError):  # as Python does where it cannot write
                Path(self.directory).mkdir(exist_ok=True)
                super().dump_bytecode(bucket)


@cache
def _environment() -> jinja2.Environment:
    made = jinja2.Environment(
        loader=jinja2.FileSystemLoader([_TEMPLATES, _TEMPLATES.parents[2]]),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        finalize=_shown,
        trim_blocks=True,
        lstrip_blocks=True,
        auto_reload=False,
        bytecode_cache=_Compiled(str(_TEMPLATES / "__pycache__"), "%s.cache"),
    )
    made.filters |= {
        "name": _name,
        "prose": _prose,
        "short": shortened,
        "number": number,
        "when": when,
        "duration": duration,
        "days": in_days,
        "g": lambda value: f"{float(value):.4g}",
    }
    made.globals |= {
        "marker": Markup(MARKER),
        "percent": percent,
        "policy": _policy,
        "style": _style,
        "script": lambda: Markup(script()),
        "score_bins": score_bins,
        "mark_of": mark_of,
    }
    return made


def _shown(value: Any) -> Any:
    """Every value that goes into a page: control characters are spelled out, line breaks stay."""
    if isinstance(value, Markup) or not isinstance(value, str) or value.isprintable():
        return value
    return "\n".join(map(one_line, value.split("\n")))


@lru_cache(maxsize=4096)
def _name(student: str) -> Markup:
    """A name on one line, isolated so that one written from right to left does not turn its surroundings."""
    return Markup("<bdi>{}</bdi>").format(one_line(shortened(student, _LONGEST_NAME)))


@lru_cache(maxsize=8192)  # the same few hundred sentences stand on every student's page
def _prose(value: str, longest: int = 2000) -> Markup:
    """A sentence of ours, in which `code` stands between backquotes; whatever it quotes is text."""
    text = str(escape(_shown(shortened(value.strip(), longest))))  # joining Markup would escape again
    return Markup(_CODE.sub(r"<code>\1</code>", text))


@cache
def _style(more: str = "") -> Markup:
    lines = [*(_TEMPLATES / "page.css").read_text("utf-8").splitlines(), *more.splitlines()]
    return Markup("\n".join(line.strip() for line in lines if line.strip()))


@cache
def _policy(scripted: bool) -> Markup:
    """Nothing is loaded from anywhere; the one script that may run is known by its digest."""
    allowed = (
        "default-src 'none'; style-src 'unsafe-inline'; img-src data:; base-uri 'none'; form-action 'none'"
    )
    if not scripted:
        return Markup(allowed)
    digest = base64.b64encode(hashlib.sha256(script().encode()).digest()).decode()
    return Markup(f"{allowed}; script-src 'sha256-{digest}'")


# ---
# The page about a class: where it struggles, which students need a look, and how it was graded.
#
# For the instructor.


_EXCEPTIONS = {"ungradable": "could not be graded", "grader_error": "fault of the grader"}
#: Protection level -> what a submission cannot do there.
_LEVELS = {
    "L3": "no file but its own, no network, no other process, limited time and memory",
    "L2": "no file but its own and Python's, no network, no other process; its temporary folder has no quota",
    "L1": "a process of its own with a deadline; files and the network were open to it",
}


def class_page(results: Results, tally: Tally, links: Mapping[str, str], index: str) -> str:
    """The whole page.

    Args:
        links: student -> address of the student's page.
        index: address of the list of students.
    """
    begun = [item for item in tally.exercises.values() if item.results]
    sections = [
        ("exercises", "Exercises"),
        ("tasks", "Hardest tasks"),
        ("diagnoses", "Most common mistakes"),
        *((f"exercise-{at}", item.exercise.title) for at, item in enumerate(begun, 1)),
        ("time", "Time per submission"),
        ("protection", "Protection"),
        ("ungraded", "Not graded"),
        ("overrides", "Scores set by hand"),
        ("late", "Late submissions"),
    ]
    return render(
        "class",
        scripted=True,
        results=results,
        course=f"{results.course.id} {results.course.version}".strip(),
        tally=tally,
        links=links,
        index=index,
        begun=begun,
        sections=sections,
        most=15,  # rows of the two lists that rank
        facts=_facts(tally),
        faults=sum(item.faults for item in tally.exercises.values()),
        middle=_middle,
        means=_mean_points,
        otherwise=_otherwise,
        timed=[(item, _times(item.seconds)) for item in begun if item.seconds],
        time_bins=duration_bins([value for item in begun for value in item.seconds]),
        states=_EXCEPTIONS,
        levels=_LEVELS,
        longest=300,  # characters of a reason
    )


def _facts(tally: Tally) -> list[tuple[int, str, str]]:
    """A count, its words, and the section that it leads to."""
    every = tally.exercises.values()
    facts = [
        (tally.students, "students", ""),
        (sum(len(item.scores) for item in every), "graded results", ""),
        (sum(item.passed for item in every), "of them pass", ""),
        (sum(item.ungraded for item in every), "could not be graded", "ungraded"),
        (sum(item.waiting for item in every), "not graded yet: no run has looked at it", "exercises"),
        (sum(item.missing for item in every), "missing: nothing handed in", "exercises"),
        (sum(item.faults for item in every), "faults of the grader", "ungraded"),
        (tally.overrides.count, "scores set by hand", "overrides"),
        (tally.late.count, "handed in late", "late"),
    ]
    return [*facts[:4], *(fact for fact in facts[4:] if fact[0])]  # the others only where there are any


def _middle(scores: Sequence[float]) -> tuple[str, str]:
    return (format_points(median(scores)), format_points(mean(scores))) if scores else ("–", "–")


def _mean_points(item: ExerciseTally) -> list[tuple[str, float, float]]:
    """Each task's average; without lateness and overrides, which are about the whole exercise."""
    return [
        (task.task, round(task.points / task.submissions, 2), round(task.max_points / task.submissions, 2))
        for task in item.tasks.values()
    ]


def _otherwise(check: CheckTally, quiz: bool) -> str:
    """How the others ended, the most common first."""
    words = {
        "fail": "wrong" if quiz else "failed", "error": "raised an error", "timeout": "took too long",
        "memory": "ran out of memory", "crash": "ended its process", "skip": "not run",
        "unwritten": "not written",
    }  # fmt: skip
    others = [(count, words.get(state, state)) for state, count in check.statuses.items() if state != "pass"]
    return ", ".join(f"{count} {how}" for count, how in sorted(others, reverse=True))


def _times(values: Sequence[float]) -> tuple[float, float, float]:
    """Median, 95th percentile and longest, in s."""
    seconds = sorted(values)
    return median(seconds), seconds[min(len(seconds) - 1, int(0.95 * len(seconds)))], seconds[-1]


# ---
# The list of students: the number of each student's page, and all scores. For the instructor.


@dataclass(frozen=True, slots=True)
class IndexRow:
    """One student: number of the page, and for each exercise the points and anything unusual."""

    student: str
    place: int
    href: str
    person: Person | None
    scores: tuple[tuple[float | None, str] | None, ...]


def _score(effective: Effective | None) -> tuple[float | None, str] | None:
    if effective is None:
        return None
    remarks = []
    if effective.override is not None:
        remarks.append("by hand")
    elif effective.missing:
        remarks.append("missing")
    elif effective.waiting:
        remarks.append("not graded yet")
    elif effective.score is None:
        remarks.append("fault of the grader")
    elif effective.verdict.state != "graded":
        remarks.append("not graded")
    elif not effective.passed:
        remarks.append("not passed")
    if effective.late is not None:
        remarks.append("late")
    return effective.score, ", ".join(remarks)


def index_page(
    results: Results, rows: Sequence[IndexRow], exercises: Sequence[GradedExercise], report: str
) -> str:
    return render(
        "students",
        scripted=True,
        course=f"{results.course.id} {results.course.version}".strip(),
        rows=rows,
        exercises=exercises,
        roster=results.roster is not None,
        report=report,
    )


# ---
# One student's page, to hand out: what was found, the likely mistake, what to do, and the points.
#
# It has only what ``handout`` lets this student see, and nothing about other students.


_LONGEST_VALUE = 600  # characters: a student's function may return anything
_LONGEST_OUTPUT = 4000
#: Status of a check -> the sign and the words a student reads.
_STATES = {
    Status.PASS: ("✓", "passes"),
    Status.FAIL: ("✗", "does not pass"),
    Status.ERROR: ("✗", "raised an error"),
    Status.TIMEOUT: ("✗", "took too long"),
    Status.MEMORY: ("✗", "used too much memory"),
    Status.CRASH: ("✗", "ended its process"),
    Status.SKIP: ("–", "not run"),
}


@dataclass(frozen=True)
class _Shown:
    """A student's result in one exercise, as the page has it: unsolved tasks first, and in each failed
    checks."""

    title: str
    effective: Effective
    problem: Problem | None
    tasks: list[tuple[str, list[CheckResult]]]
    titles: dict[str, str]
    bars: list[tuple[str, float, float]]

    @property
    def quiz(self) -> bool:
        return self.effective.exercise == QUIZ

    @property
    def points(self) -> str:
        item = self.effective
        score = "none" if item.missing else "none yet" if item.score is None else number(item.score)
        return f"{score} of {number(item.max_score)}"

    @property
    def outcome(self) -> str:
        """How it ended, in a few words."""
        item = self.effective
        if item.missing:
            return "nothing was handed in"
        if item.waiting:
            return "not graded yet"
        if item.score is None:
            return "to be graded again"
        passed = "passed" if item.passed else "not passed"
        if item.override is not None:
            return f"{passed}, set by the instructor"
        if item.verdict.state != "graded":
            return "could not be graded"
        return f"{passed}, {in_points(item.penalty)} off for lateness" if item.penalty else passed


def student_page(results: Results, student: str, found: Sequence[Effective]) -> str:
    person = results.person(student)
    called = person.name if person and person.name else student
    shown = [_shown_result(results, item) for item in found]
    scored = [(one.title, one.effective.score, one.effective.max_score) for one in shown]
    return render(
        "student",
        scripted=False,
        title=f"{shortened(one_line(called), 80)}: results",
        course=results.course.id,
        called=called,
        student=student,
        shown=shown,
        scored=[row for row in scored if row[1] is not None],
        state_of=_state_of,
        share_of=_share_of,
        numbers=_numbers,
        cut=_cut,
    )


def _shown_result(results: Results, item: Effective) -> _Shown:
    checks = checks_for_student(item.verdict)
    by_task: dict[str, list[CheckResult]] = {}
    for check in checks:
        by_task.setdefault(check.task, []).append(check)
    bars = [
        (task, sum(check.points for check in group), sum(check.max_points for check in group))
        for task, group in by_task.items()
    ]
    done = {task: all(check.status is Status.PASS for check in group) for task, group in by_task.items()}
    tasks = [(task, _gathered(by_task[task])) for task in sorted(by_task, key=done.__getitem__)]
    problem = problem_for_student(item.verdict) if item.result.number else None
    titles = {check.id: check.title for check in checks}
    return _Shown(results.title(item.exercise), item, problem, tasks, titles, bars)


def _gathered(checks: list[CheckResult]) -> list[CheckResult]:
    """A task's checks; as one, those of a function that is not written, or of which only the same is said."""
    alike: dict[object, list[CheckResult]] = {}
    unwritten = any(check.unwritten for check in checks)
    for check in checks:
        if check.unwritten or (unwritten and check.status is Status.SKIP):
            alike.setdefault("unwritten", []).append(check)
        elif check.status is Status.PASS or not check.input is check.actual is check.stdout is None:
            alike[check.id] = [check]
        else:
            told = (check.status, check.message, check.help, check.blocked_by, check.traceback)
            alike.setdefault((*told, check.visibility), []).append(check)
    return [_as_one(same) if len(same) > 1 else same[0] for same in alike.values()]


def _as_one(checks: list[CheckResult]) -> CheckResult:
    first = next((check for check in checks if check.unwritten), checks[0])
    many = counted(len(checks), "check")
    return msgspec.structs.replace(
        first,
        title=many if first.unwritten else f"{many}: {'; '.join(check.title for check in checks)}",
        points=sum(check.points for check in checks),
        max_points=sum(check.max_points for check in checks),
        traceback=None if first.unwritten else first.traceback,
    )


def _state_of(check: CheckResult, quiz: bool) -> tuple[str, str]:
    if check.unwritten:
        return "–", "not written"
    return ("✗", "not right") if quiz else _STATES.get(check.status, ("✗", "does not pass"))


def _share_of(check: CheckResult) -> str:
    kept_back = ", hidden check" if check.visibility is Visibility.HIDDEN else ""
    points = f"{number(check.points)} of {in_points(check.max_points)}" if check.max_points else "no points"
    return f"{points}{kept_back}"


def _numbers(check: CheckResult) -> list[tuple[str, str]]:
    """The measured and the expected value."""
    return [(label, shortened(value, _LONGEST_VALUE)) for label, value in numbers_of(check)]


def _cut(body: str) -> str:
    """Its start and its end, which names the error."""
    if len(body) <= _LONGEST_OUTPUT:
        return body
    half = _LONGEST_OUTPUT // 2
    return f"{body[:half]}\n…\n{body[-half:]}"


_PAGE = re.compile(r"[1-9][0-9]*\.html")


def write_html(target: Path, results: Results, options: ExportOptions) -> Written:
    """The page about the class, the list of students, and the students' pages beside it.

    Args:
        target: the page (``.html``), or the folder it goes into.

    Raises:
        UsageError: files are in the way that no export to this page made.
    """
    selection = select(results, options)
    page = target.suffix.lower() in {".html", ".htm"} and not target.is_dir()
    path = target if page else target / "report.html"
    _refuse_others(path, len(results.students()), named=page)
    paths = write_pages(path, results, selection.each(), selection.exercises)
    selection.written.paths += paths
    selection.written.notes.append(
        "Pages in the folder students can be handed out, each to its student; the list of students is yours."
    )
    return selection.written


def _refuse_others(path: Path, students: int, *, named: bool) -> None:
    """Refuse to replace or remove what no earlier export to this page made: its list of students links to
    it. So many pages are numbered; ``named``: the user named the page itself, and not its folder."""
    listed, table, folder = (path.with_name(name) for name in ("students.html", "students.csv", "students"))
    numbered = [*folder.iterdir()] if folder.is_dir() else []
    pages = [page for page in numbered if _PAGE.fullmatch(page.name)]
    pages = [page for page in pages if int(page.stem) <= students or _is_ours(page)]
    again = _is_ours(listed) and f'href="{_link(path)}"' in listed.read_text("utf-8", "replace")
    others = [page for page in pages if not _is_ours(page)] if again else [listed, table, *pages]
    others += [path] * (not named and not _is_ours(path))
    refuse_to_replace(path.parent, others, path.name)


def _is_ours(path: Path) -> bool:
    return begins(path, MARKER.encode())


def _link(path: Path) -> str:
    return quote(os.fsencode(path.name))


def write_pages(
    path: Path, results: Results, found: Iterable[Effective], exercises: Sequence[str]
) -> list[Path]:
    """Write everything.

    Args:
        path: of the page about the class; the rest lies beside it.
        found: results ordered by student; those that have only an override may come at the end.
        exercises: ids, in the order they are shown.

    Returns:
        The written paths: the class page, the list of students as a page and as a table, the folder of pages.
    """
    noted = {item.id: item for item in results.exercises()}
    order = {name: at for at, name in enumerate(exercises)}
    numbers = {student: at for at, student in enumerate(results.students(), 1)}
    links = {student: f"students/{at}.html" for student, at in numbers.items()}
    folder = path.parent / "students"
    tally = Tally(noted[name] for name in exercises)
    rows = {}
    for student, group in _by_student(results, found):
        mine = sorted(group, key=lambda effective: order[effective.exercise])
        tally.take(mine)
        place = numbers[student]
        write_bytes(folder / f"{place}.html", student_page(results, student, mine).encode())
        by_exercise = {effective.exercise: effective for effective in mine}
        told = tuple(_score(by_exercise.get(name)) for name in exercises)
        rows[student] = IndexRow(student, place, links[student], results.person(student), told)
    shown = sorted(rows.values(), key=lambda row: row.place)
    listed, table = path.with_name("students.html"), path.with_name("students.csv")
    chosen = [noted[name] for name in exercises]
    write_bytes(listed, index_page(results, shown, chosen, _link(path)).encode())
    cells = []
    for row in shown:
        person = (row.person.name, row.person.email) if row.person else ("", "")
        scores = (number(score[0]) if score else "" for score in row.scores)
        cells.append([row.href, row.student, *person, *scores])
    write_bytes(table, csv_bytes(("page", "student", "name", "email", *exercises), cells))
    write_bytes(path, class_page(results, tally, links, _link(listed)).encode())
    _remove_others(folder, {f"{row.place}.html" for row in shown})
    return [path, listed, table, folder]


def _by_student(results: Results, found: Iterable[Effective]) -> Iterator[tuple[str, list[Effective]]]:
    """All results of one student together.

    A student with an override for work that was not handed in has that result at the end, so the others wait
    for it.
    """
    held: dict[str, list[Effective]] = {override.student: [] for override in results.book.overrides()}
    for student, group in itertools.groupby(found, key=lambda effective: effective.student):
        if student in held:
            held[student] += group
        else:
            yield student, list(group)
    yield from ((student, group) for student, group in held.items() if group)


def _remove_others(folder: Path, written: set[str]) -> None:
    """Delete the pages of an earlier class: their numbers may belong to other students now."""
    for path in folder.iterdir() if folder.is_dir() else ():
        if _PAGE.fullmatch(path.name) and path.name not in written and _is_ours(path):
            with contextlib.suppress(OSError):
                path.unlink()
