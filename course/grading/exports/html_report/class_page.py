"""The page about a class: where it struggles, who needs a look, and how it was graded. For the instructor."""

from __future__ import annotations

from statistics import mean, median
from typing import TYPE_CHECKING

from course.grading.exports.cells import number
from course.grading.exports.html_report.charts import (
    bar_rows,
    duration,
    duration_bins,
    histogram,
    mark_of,
    meter,
    percent,
    score_bins,
)
from course.grading.exports.html_report.lists import late_list, overrides_list, protection, troubled_list
from course.grading.exports.html_report.markup import (
    Html,
    joined,
    name_of,
    page,
    prose,
    region_table,
    tag,
)
from course.grading.exports.html_report.words import when
from course.scoring.numbers import format_points

if TYPE_CHECKING:
    from collections.abc import Mapping

    from course.grading.exports.html_report.markup import Heading
    from course.grading.exports.html_report.tally import (
        CheckTally,
        DiagnosisTally,
        ExerciseTally,
        Tally,
        TaskTally,
    )
    from course.grading.results.effective import Results

__all__ = ["class_page"]

_MOST = 15  # rows of the two lists that rank


def class_page(results: Results, tally: Tally, links: Mapping[str, str], index: str) -> Html:
    """The whole page.

    Args:
        tally: the class, counted.
        links: student -> address of the student's page.
        index: address of the list of students.
    """
    begun = [item for item in tally.exercises.values() if item.results]
    sections: list[tuple[str, str, Html]] = [
        ("exercises", "Exercises", _exercises(begun)),
        ("tasks", "Hardest tasks", _tasks(results, tally)),
        ("diagnoses", "Commonest diagnoses", _diagnoses(results, tally)),
        *((f"exercise-{at}", item.exercise.title, _exercise(item)) for at, item in enumerate(begun, 1)),
        ("time", "Time per submission", _time(results, tally, links)),
        ("protection", "Protection", protection(tally)),
        ("ungraded", "Not graded", troubled_list(results, tally, links)),
        ("overrides", "Scores set by hand", overrides_list(results, tally, links)),
        ("late", "Late", late_list(results, tally, links)),
    ]
    contents = [tag("li", tag("a", title, href=f"#{anchor}")) for anchor, title, _ in sections]
    students = tag("li", tag("a", "List of students", href=index))
    navigation = tag("nav", tag("ul", students, joined(contents)), aria_label="Sections")
    body = [
        tag(
            "section",
            tag("h2", title, id=anchor),
            inside,
            class_="exercise" if anchor.startswith("exercise-") else None,
        )
        for anchor, title, inside in sections
    ]
    course = f"{results.course.id} {results.course.version}".strip()
    header = joined(
        (
            tag("h1", "Class report"),
            tag("p", tag("strong", course), _span(tally), class_="soft"),
            tag("p", "For the instructor: it has the names of students.", class_="soft"),
        )
    )
    main = joined((_facts(tally), _attention(tally), *body))
    return page(f"Class report: {course}", header, navigation, main, _footer(results, tally), scripted=True)


def _span(tally: Tally) -> str:
    if not tally.first:
        return ""
    first, last = when(tally.first), when(tally.last)
    return f", graded {first}" if first == last else f", graded {first} to {last}"


def _facts(tally: Tally) -> Html:
    every = tally.exercises.values()
    scored = sum(len(item.scores) for item in every)
    facts = [
        (tally.students, "students", ""),
        (scored, "results with a grade", ""),
        (sum(item.passed for item in every), "of them pass", ""),
        (sum(item.ungraded for item in every), "could not be graded", "ungraded"),
    ]
    more = [
        (sum(item.faults for item in every), "faults of the grader", "ungraded"),
        (tally.overrides.count, "scores set by hand", "overrides"),
        (tally.late.count, "handed in late", "late"),
    ]
    cells = []
    for count, words, anchor in [*facts, *(fact for fact in more if fact[0])]:
        linked = tag("a", words, href=f"#{anchor}") if anchor and count else words
        cells.append(tag("div", tag("dt", linked), tag("dd", str(count))))
    return tag("dl", *cells, class_="facts")


def _attention(tally: Tally) -> Html:
    """What the instructor has to do something about, if anything."""
    said = []
    faults = sum(item.faults for item in tally.exercises.values())
    if faults:
        rerun = tag("code", "course grade rerun")
        said.append(
            tag("li", f"{faults} results have no score for a fault of the grader: ", rerun, " grades them.")
        )
    if tally.flagged:
        said.append(
            tag("li", f"{tally.flagged} are called late by the download, and nobody says by how much: ",
                tag("code", "course grade late --times"), " takes a list of times.")
        )  # fmt: skip
    if "L1" in tally.levels:
        said.append(
            tag(
                "li",
                f"{tally.levels['L1']} submissions ran at L1: they could read files and use the network.",
            )
        )
    if not said:
        return Html("")
    return tag(
        "section", tag("strong", "To look at"), tag("ul", *said), class_="note", aria_label="To look at"
    )


def _exercises(begun: list[ExerciseTally]) -> Html:
    rows = []
    for item in begun:
        scores = sorted(item.scores)
        middle = [format_points(value) for value in (median(scores), mean(scores))] if scores else ["–", "–"]
        about = tag("small", f"{number(item.exercise.max_points)} points in all")
        passed = tag("small", percent(item.passed, len(scores))) if scores else Html("")
        cells = [
            tag("th", item.exercise.title, about, scope="row"),
            tag("td", str(len(scores)), tag("small", f"of {item.results}"), class_="n"),
            tag("td", str(item.passed), passed, class_="n"),
            *(tag("td", value, class_="n") for value in middle),
        ]
        rows.append(tag("tr", *cells))
    numbers = ["With a grade", "Passed", "Median", "Mean"]
    heads: list[Heading] = ["Exercise", *((words, "n") for words in numbers)]
    note = (
        "Scores as they count: overrides and lateness included. What could not be graded counts as zero in "
        "an export and is left out of every statistic here."
    )
    table = region_table("Students with a result, and their scores", heads, rows)
    return joined((table, tag("p", note, class_="soft")))


def _tasks(results: Results, tally: Tally) -> Html:
    ranked = tally.hardest
    if not ranked:
        return tag("p", "No task was graded.")
    rows = [_task(results, task) for task in ranked[:_MOST]]
    heads: list[Heading] = ["Task", ("Points reached", "rate")]
    more = len(ranked) - _MOST
    note = (
        tag("p", f"{more} more gave a larger share of their points.", class_="soft") if more > 0 else Html("")
    )
    caption = "Tasks by the share of their points that the class reached, the smallest first"
    return joined((region_table(caption, heads, rows, sortable=True), note))


def _task(results: Results, task: TaskTally) -> Html:
    counts = f"{task.full} of {task.submissions} have all points, {task.none} have none"
    return tag(
        "tr",
        tag("th", tag("code", task.task), tag("small", results.title(task.exercise)), scope="row"),
        _rate(task.points, task.max_points, counts),
    )


def _rate(part: float, whole: float, more: str = "") -> Html:
    """A cell with a share in words and as a bar."""
    words = tag("span", percent(part, whole), tag("small", more) if more else Html(""))
    return tag("td", words, meter(part, whole), data_value=part / whole if whole else 0.0, class_="rate")


def _diagnoses(results: Results, tally: Tally) -> Html:
    ranked = tally.commonest
    if not ranked:
        return tag("p", "No mistake that has a name was seen.")
    rows = [_diagnosis(results, tally, item) for item in ranked[:_MOST]]
    heads: list[Heading] = ["Diagnosis, and what students are told", ("Students", "rate")]
    more = len(ranked) - _MOST
    note = tag("p", f"{more} more were seen in fewer students.", class_="soft") if more > 0 else Html("")
    caption = "Mistakes by the number of students who made them"
    return joined((region_table(caption, heads, rows, sortable=True), note))


def _diagnosis(results: Results, tally: Tally, item: DiagnosisTally) -> Html:
    whole = tally.exercises[item.exercise]
    graded = max((check.submissions for check in whole.checks.values()), default=0)
    tasks = "" if whole.is_quiz else ": " + ", ".join(item.tasks)
    told = tag("small", prose(item.told, 300)) if item.told else Html("")
    of = tag("small", f"of {graded}, {percent(item.students, graded)}")
    return tag(
        "tr",
        tag(
            "th",
            tag("code", item.code),
            tag("small", results.title(item.exercise), tasks),
            told,
            scope="row",
        ),
        tag(
            "td",
            str(item.students),
            of,
            meter(item.students, graded),
            data_value=item.students,
            class_="rate",
        ),
    )


def _exercise(item: ExerciseTally) -> Html:
    quiz = item.is_quiz
    bins, each = score_bins(item.scores, item.exercise.max_points)
    share = item.exercise.pass_share
    place = mark_of(share, item.exercise.max_points, each=each)
    chart = histogram(
        bins,
        caption=f"Scores of {len(item.scores)} students",
        axis="points" if each else f"% of {number(item.exercise.max_points)} points",
        last="" if each else "100",
        middle=each,
        mark=(place, f"pass mark {number(share * item.exercise.max_points)}"),
    )
    rows = [_check(check, quiz=quiz) for check in item.checks.values()]
    if not rows:
        return joined((chart, tag("p", "No submission could be graded.")))
    heads: list[Heading] = ["Question" if quiz else "Check", ("Right" if quiz else "Passed", "rate")]
    caption = "Right answers per question" if quiz else "Pass rate per check"
    charts = chart if quiz else tag("div", chart, _mean_points(item), class_="beside")
    return joined((charts, region_table(caption, heads, rows, sortable=True)))


def _mean_points(item: ExerciseTally) -> Html:
    """What each task gave on average; lateness and overrides are about the whole and not in it."""
    rows = [
        (task.task, round(task.points / task.submissions, 2), round(task.max_points / task.submissions, 2))
        for task in item.tasks.values()
    ]
    return bar_rows(rows, "Mean points by task, as the checks gave them", code=True)


def _check(check: CheckTally, *, quiz: bool) -> Html:
    latest = check.latest
    kind = "hidden" if check.hidden else "public"
    points = f", {kind}, {number(latest.max_points)} points"
    about = Html("") if quiz else tag("small", tag("code", latest.task), points)
    counts = f"{check.passed} of {check.submissions}"
    others = _otherwise(check, quiz=quiz)
    return tag(
        "tr",
        tag("th", latest.title, about, scope="row"),
        _rate(check.passed, check.submissions, f"{counts}; {others}" if others else counts),
    )


def _otherwise(check: CheckTally, *, quiz: bool) -> str:
    """How the others ended, the commonest first."""
    words = {
        "fail": "wrong" if quiz else "failed", "error": "raised an error", "timeout": "took too long",
        "memory": "ran out of memory", "crash": "ended its process", "skip": "not run",
    }  # fmt: skip
    others = [(count, words.get(state, state)) for state, count in check.statuses.items() if state != "pass"]
    return ", ".join(f"{count} {how}" for count, how in sorted(others, reverse=True))


def _time(results: Results, tally: Tally, links: Mapping[str, str]) -> Html:
    timed = [item for item in tally.exercises.values() if item.seconds]
    if not timed:
        return tag("p", "No submission was run.")
    rows = []
    for item in timed:
        seconds = sorted(item.seconds)
        cells = [median(seconds), seconds[min(len(seconds) - 1, int(0.95 * len(seconds)))], seconds[-1]]
        name = tag("th", item.exercise.title, scope="row")
        rows.append(tag("tr", name, *(tag("td", duration(cell), class_="n") for cell in cells)))
    every = [value for item in timed for value in item.seconds]
    heads: list[Heading] = ["Exercise", ("Median", "n"), ("19 of 20 below", "n"), ("Longest", "n")]
    slowest = [
        tag(
            "tr",
            _student(student, links),
            tag("td", results.title(exercise)),
            tag("td", duration(value), class_="n"),
        )
        for value, student, exercise in tally.slowest
    ]
    by_exercise = region_table("Time by exercise", heads, rows)
    longest = region_table("The slowest", ["Student", "Exercise", ("Time", "n")], slowest)
    chart = histogram(duration_bins(every), caption=f"Time of {len(every)} submissions", axis="time")
    return joined(
        (
            tag("p", "Wall time of all checks of a submission, on the machine that graded.", class_="soft"),
            tag("div", chart, tag("div", by_exercise, longest), class_="beside"),
        )
    )


def _student(student: str, links: Mapping[str, str]) -> Html:
    return tag("th", tag("a", name_of(student), href=links[student]), scope="row")


def _footer(results: Results, tally: Tally) -> Html:
    versions = [
        f"{exercise} {version[:16]} ({count})"
        for (exercise, version), count in sorted(tally.versions.items())
    ]
    seed = tag("p", f"Seed of the hidden inputs: {results.seed}.")
    return joined((seed, tag("p", f"Versions of the graders: {', '.join(versions)}."))) if versions else seed
