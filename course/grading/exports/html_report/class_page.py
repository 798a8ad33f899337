"""The page about a class: where it struggles, which students need a look, and how it was graded.

For the instructor."""

from __future__ import annotations

from statistics import mean, median
from typing import TYPE_CHECKING

from course.grading.exports.html_report.charts import duration_bins
from course.grading.exports.html_report.rendering import render
from course.scoring.numbers import format_points

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from course.grading.exports.html_report.tally import CheckTally, ExerciseTally, Tally
    from course.grading.results.effective import Results

__all__ = ["class_page"]

_STATES = {"ungradable": "could not be graded", "grader_error": "fault of the grader"}
#: Protection level -> what a submission cannot do there.
_LEVELS = {
    "L3": "no file but its own, no network, no other process, limited time and memory",
    "L2": "no file but its own and Python's, no network, no other process; its temporary folder has no quota",
    "L1": "a process of its own with a deadline; files and the network were open to it",
}


def class_page(results: Results, tally: Tally, links: Mapping[str, str], index: str) -> str:
    """The whole page.

    Args:
        tally: the class, counted.
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
        states=_STATES,
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
    ]
    more = [
        (sum(item.waiting for item in every), "not graded yet: the run was interrupted", "exercises"),
        (sum(item.missing for item in every), "missing: enrolled, nothing handed in", "exercises"),
        (sum(item.faults for item in every), "faults of the grader", "ungraded"),
        (tally.overrides.count, "scores set by hand", "overrides"),
        (tally.late.count, "handed in late", "late"),
    ]
    return [*facts, *(fact for fact in more if fact[0])]


def _middle(scores: Sequence[float]) -> tuple[str, str]:
    """Median and mean."""
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
    }  # fmt: skip
    others = [(count, words.get(state, state)) for state, count in check.statuses.items() if state != "pass"]
    return ", ".join(f"{count} {how}" for count, how in sorted(others, reverse=True))


def _times(values: Sequence[float]) -> tuple[float, float, float]:
    """Median, 95th percentile and longest, in s."""
    seconds = sorted(values)
    return median(seconds), seconds[min(len(seconds) - 1, int(0.95 * len(seconds)))], seconds[-1]
