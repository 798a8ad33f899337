"""The lists of the class page: who could not be graded, whose score was set, who was late, at what level."""

from __future__ import annotations

from typing import TYPE_CHECKING

from course.grading.exports.cells import number
from course.grading.exports.html_report.markup import (
    Html,
    joined,
    name_of,
    prose,
    region_table,
    shortened,
    tag,
)
from course.grading.exports.html_report.words import when
from course.grading.results.late import in_days

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from course.grading.exports.html_report.markup import Heading
    from course.grading.exports.html_report.tally import Listed, Tally
    from course.grading.results.effective import Effective, Results

__all__ = ["late_list", "overrides_list", "protection", "troubled_list"]

_LONGEST = 300  # characters of a reason
_STATES = {"ungradable": "could not be graded", "grader_error": "fault of the grader"}
#: Protection level -> what it keeps a submission from.
_LEVELS = {
    "L3": "no file but its own, no network, no other process, limited time and memory",
    "L2": "no file but its own and Python's, no network, no other process; its temporary folder has no quota",
    "L1": "a process of its own with a deadline; files and the network were open to it",
}


def troubled_list(results: Results, tally: Tally, links: Mapping[str, str]) -> Html:
    """Who could not be graded and why: counted by reason, then one by one."""
    if not tally.troubled.count:
        return tag("p", "Everything that was handed in could be graded.")
    counted = [
        tag(
            "tr",
            tag("th", tag("code", code), scope="row"),
            tag("td", _STATES.get(state, state)),
            tag("td", results.title(exercise)),
            tag("td", str(count), class_="n"),
        )
        for (exercise, state, code), count in tally.reasons.most_common()
    ]
    heads: list[Heading] = ["Reason", "Outcome", "Exercise", ("Students", "n")]

    def row(effective: Effective) -> Html:
        error = effective.verdict.error
        assert error is not None
        student = _student(effective, results, links, tag("small", tag("code", error.code)))
        by_hand = "" if effective.override is None else f"Score set by hand: {number(effective.score)}."
        told = tag("td", prose(error.message, _LONGEST), tag("small", prose(error.help, _LONGEST)), by_hand)
        return tag("tr", student, told)

    names = _one_by_one(tally.troubled, "One by one", ["Student", "What happened"], row)
    return joined((region_table("By reason", heads, counted), names))


def overrides_list(results: Results, tally: Tally, links: Mapping[str, str]) -> Html:
    """Every score an instructor set, with the reason."""
    if not tally.overrides.count:
        return tag("p", "None.")

    def row(effective: Effective) -> Html:
        override, raw = effective.override, effective.raw_score
        assert override is not None
        gave = number(raw) if effective.result.number and raw is not None else "–"
        score = f"{number(effective.score)} of {number(effective.max_score)}"
        return tag(
            "tr",
            _student(effective, results, links),
            tag("td", score, tag("small", f"checks: {gave}"), class_="n"),
            tag("td", shortened(override.reason, _LONGEST), tag("small", when(override.at))),
        )

    heads: list[Heading] = ["Student", ("Score", "n"), "Reason"]
    return _one_by_one(tally.overrides, "Scores that count in place of the graders'", heads, row)


def late_list(results: Results, tally: Tally, links: Mapping[str, str]) -> Html:
    """Who was late, and what it cost."""
    if results.policy is None:
        said = "No late policy is set, so nothing is late."
    else:
        cost = f"; it cost {tally.penalised} of them points" if tally.late.count else ""
        said = f"{tally.late.count} were handed in after their deadline{cost}."
        if tally.untimed:
            said += f" Of {tally.untimed} no trusted time is known; they count as in time."
    if tally.flagged:
        said += f" The download calls {tally.flagged} late and does not say by how much."
    if not tally.late.count:
        return tag("p", said)

    def row(effective: Effective) -> Html:
        return tag(
            "tr",
            _student(effective, results, links),
            tag("td", in_days(effective.late or 0.0), class_="n", data_value=effective.late or 0.0),
            tag("td", number(effective.penalty), class_="n"),
            tag("td", number(effective.score), class_="n"),
        )

    heads: list[Heading] = ["Student", ("Late by", "n"), ("Points off", "n"), ("Score", "n")]
    return joined((tag("p", said), _one_by_one(tally.late, "Handed in late, the latest first", heads, row)))


def protection(tally: Tally) -> Html:
    """At which level students' code ran."""
    if not tally.levels:
        return tag("p", "No student's code was run.")
    rows = [
        tag(
            "tr",
            tag("th", level, scope="row"),
            tag("td", str(count), class_="n"),
            tag("td", _LEVELS.get(level, "unknown")),
        )
        for level, count in sorted(tally.levels.items())
    ]
    heads: list[Heading] = ["Level", ("Submissions", "n"), "What a submission could reach"]
    return region_table("Protection level that submissions ran at", heads, rows)


def _one_by_one(listed: Listed, caption: str, heads: list[Heading], row: Callable[[Effective], Html]) -> Html:
    table = region_table(caption, heads, [row(effective) for effective in listed.shown], sortable=True)
    if not listed.left_out:
        return table
    more = f"{listed.left_out} more are not listed here; grades.csv has them all."
    return joined((table, tag("p", more, class_="soft")))


def _student(effective: Effective, results: Results, links: Mapping[str, str], *more: Html) -> Html:
    student = tag("a", name_of(effective.student), href=links[effective.student])
    return tag("th", student, tag("small", results.title(effective.exercise)), *more, scope="row")
