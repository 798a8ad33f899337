"""One student's page, to be handed out: what was found, what it looks like, what to do, and the points.

It is made of what ``handout`` lets students see and knows of nobody else.
"""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING

from course.grading.exports.cells import number
from course.grading.exports.handout import checks_for_student, problem_for_student
from course.grading.exports.html_report.charts import bar_rows
from course.grading.exports.html_report.markup import (
    Html,
    joined,
    name_of,
    page,
    paragraphs,
    region_table,
    shortened,
    tag,
)
from course.grading.exports.html_report.words import when
from course.grading.quiz import EXERCISE_ID as QUIZ
from course.grading.results.late import in_days
from course.printable import one_line
from course.scoring.numbers import numbers_of
from course.scoring.verdict import CheckResult, Problem, Status, Visibility

if TYPE_CHECKING:
    from collections.abc import Sequence

    from course.grading.results.effective import Effective, Results

__all__ = ["student_page"]

_LONGEST_VALUE = 600  # characters: a student's function may return anything
_LONGEST_OUTPUT = 4000
#: Status of a check -> the sign and the words a student reads.
_STATES = {
    Status.PASS: ("\u2713", "passes"),
    Status.FAIL: ("\u2717", "does not pass"),
    Status.ERROR: ("\u2717", "raised an error"),
    Status.TIMEOUT: ("\u2717", "took too long"),
    Status.MEMORY: ("\u2717", "used too much memory"),
    Status.CRASH: ("\u2717", "ended its process"),
    Status.SKIP: ("\u2013", "not run"),
}


def student_page(results: Results, student: str, found: Sequence[Effective]) -> Html:
    """The page about everything one student handed in.

    Args:
        found: the student's results, in the order of the course.
    """
    person = results.person(student)
    shown = person.name if person and person.name else student
    about = [tag("p", "Results in ", tag("strong", results.course.id), class_="soft")]
    if shown != student:
        about.append(tag("p", "Handed in as ", name_of(student), ".", class_="soft"))
    header = joined((tag("h1", name_of(shown)), *about))
    links = [
        tag("li", tag("a", results.title(item.exercise), href=f"#exercise-{at}"))
        for at, item in enumerate(found, 1)
    ]
    navigation = tag("nav", tag("ul", joined(links)), aria_label="Exercises") if len(found) > 1 else Html("")
    main = joined(
        (_overview(results, found), *(_exercise(results, item, at) for at, item in enumerate(found, 1)))
    )
    return page(
        f"{shortened(one_line(shown), 80)}: results",
        header,
        navigation,
        main,
        _footer(found),
        scripted=False,
    )


def _overview(results: Results, found: Sequence[Effective]) -> Html:
    """All exercises in one table; with a chart where there is something to compare."""
    rows = [
        tag(
            "tr",
            tag("th", results.title(item.exercise), scope="row"),
            tag("td", _points(item), class_="n"),
            tag("td", _outcome(item)),
        )
        for item in found
    ]
    table = region_table("Scores", ["Exercise", ("Points", "n"), "Outcome"], rows)
    scored = [
        (results.title(item.exercise), item.score, item.max_score) for item in found if item.score is not None
    ]
    if len(scored) < 2:
        return tag("section", tag("h2", "Overview"), table)
    chart = bar_rows(scored, "Points by exercise")
    return tag("section", tag("h2", "Overview"), tag("div", table, chart, class_="beside"))


def _points(effective: Effective) -> str:
    score = "none yet" if effective.score is None else number(effective.score)
    return f"{score} of {number(effective.max_score)}"


def _outcome(effective: Effective) -> str:
    """How it ended, in a few words."""
    if effective.score is None:
        return "to be graded again"
    if effective.override is not None:
        return f"{'passed' if effective.passed else 'not passed'}, set by the instructor"
    if effective.verdict.state != "graded":
        return "could not be graded"
    late = f", {number(effective.penalty)} points off for lateness" if effective.penalty else ""
    return f"{'passed' if effective.passed else 'not passed'}{late}"


def _exercise(results: Results, effective: Effective, at: int) -> Html:
    checks = checks_for_student(effective.verdict)
    problem = problem_for_student(effective.verdict)
    parts = [tag("h2", results.title(effective.exercise), id=f"exercise-{at}")]
    parts.append(tag("p", tag("strong", f"{_points(effective)} points"), f": {_outcome(effective)}."))
    parts += _remarks(effective)
    if problem is not None and effective.result.number:
        parts.append(_problem(problem))
    by_task: dict[str, list[CheckResult]] = {}
    for check in checks:
        by_task.setdefault(check.task, []).append(check)
    quiz = effective.exercise == QUIZ
    if len(by_task) > 1 and not quiz:
        rows = [
            (task, sum(check.points for check in group), sum(check.max_points for check in group))
            for task, group in by_task.items()
        ]
        parts.append(bar_rows(rows, "Points by task", code=True))
    titles = {check.id: check.title for check in checks}
    # What there is to do comes first.
    done = {task: all(check.status is Status.PASS for check in group) for task, group in by_task.items()}
    for task, group in sorted(by_task.items(), key=lambda item: done[item[0]]):
        if not quiz:
            parts.append(tag("h3", tag("code", task)))
        parts.append(_findings(group, titles, quiz=quiz))
    return tag("section", *parts, class_="exercise")


def _remarks(effective: Effective) -> list[Html]:
    """What the instructor decided, what lateness cost, and what else is to be said of the whole."""
    said = []
    if effective.override is not None:
        raw = "" if effective.raw_score is None else f" The checks gave {number(effective.raw_score)}."
        said.append(tag("p", f"The score was set by the instructor.{raw} The reason: "))
        said.append(tag("blockquote", paragraphs(effective.override.reason)))
    if effective.late is not None:
        cost = (
            f"{number(effective.penalty)} points were taken off {number(effective.raw_score)}"
            if effective.penalty
            else "it cost nothing"
        )
        said.append(tag("p", f"Handed in {in_days(effective.late)} after the deadline; {cost}."))
    return said + [paragraphs(warning) for warning in effective.verdict.warnings]


def _problem(problem: Problem) -> Html:
    return tag("div", paragraphs(problem.message), paragraphs(problem.help), class_="note")


def _findings(checks: Sequence[CheckResult], titles: dict[str, str], *, quiz: bool) -> Html:
    """What did not pass, at length; then what passes, a line each."""
    opened = [_finding(check, titles, quiz=quiz) for check in checks if check.status is not Status.PASS]
    passed = [_passed(check.title, _share(check)) for check in checks if check.status is Status.PASS]
    if passed:
        sign = tag("span", "\u2713 ", aria_hidden="true")
        words = tag("p", sign, "Right:" if quiz else "Passes:", class_="passes")
        opened += [words, tag("ul", joined(passed), class_="done")]
    return joined(opened)


@lru_cache(maxsize=4096)
def _passed(title: str, share: str) -> Html:
    """Of most checks the same for most students."""
    return tag("li", title, tag("span", share))


def _finding(check: CheckResult, titles: dict[str, str], *, quiz: bool) -> Html:
    sign, words = ("\u2717", "not right") if quiz else _STATES.get(check.status, ("\u2717", "does not pass"))
    state = tag("span", tag("span", f"{sign} ", aria_hidden="true"), words, class_="state")
    parts = [
        tag("header", tag("h3" if quiz else "h4", check.title), tag("span", state, f", {_share(check)}")),
        paragraphs(check.message),
        paragraphs("" if check.blocked_by else check.help),
    ]
    if check.blocked_by:
        parts.append(tag("p", f"Runs once this passes: {titles.get(check.blocked_by, check.blocked_by)}."))
    if not quiz:
        parts.append(_numbers(check))
        for label, body in (("Where it happened", check.traceback), ("What the code printed", check.stdout)):
            if body:
                # Its start and its end, which names the error.
                parts += [tag("p", label, class_="soft"), tag("pre", _cut(body))]
    waiting = check.status is Status.SKIP
    return tag("article", *parts, class_="finding waiting" if waiting else "finding open")


def _share(check: CheckResult) -> str:
    kept_back = ", hidden check" if check.visibility is Visibility.HIDDEN else ""
    return f"{number(check.points)} of {number(check.max_points)} points{kept_back}"


def _numbers(check: CheckResult) -> Html:
    """What was measured and expected, and which mistake it looks like."""
    pairs = []
    for label, value in numbers_of(check):
        shown = shortened(value, _LONGEST_VALUE)
        diagnosis = label == "diagnosis"
        pairs.append(tag("dt", "looks like" if diagnosis else label))
        pairs.append(tag("dd", tag("code", shown) if diagnosis else shown))
    return tag("dl", joined(pairs)) if pairs else Html("")


def _cut(body: str) -> str:
    if len(body) <= _LONGEST_OUTPUT:
        return body
    half = _LONGEST_OUTPUT // 2
    return f"{body[:half]}\n…\n{body[-half:]}"


def _footer(found: Sequence[Effective]) -> Html:
    """What was graded, when, and how: enough to settle which file it was."""
    lines = []
    for item in found:
        if not item.result.number:
            continue
        level = f" at protection level {item.verdict.isolation}" if item.verdict.isolation else ""
        digest = item.result.key.submission_sha256[:12]
        file = f"; SHA-256 of what was handed in begins {digest}" if digest else ""
        lines.append(tag("p", f"{item.exercise}: graded {when(item.result.graded_at)}{level}{file}."))
    hidden = tag(
        "p", "Of hidden checks, inputs and expected values are kept back; what they found is said in words."
    )
    return joined((*lines, hidden))
