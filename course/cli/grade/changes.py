"""A change of a student's result, as a terminal shows it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from course.printable import one_line
from course.scoring.numbers import format_points

if TYPE_CHECKING:
    from course.cli.frame.terminal.console import Console
    from course.grading.running.rerun import Change

__all__ = ["points", "show_change"]


def show_change(console: Console, change: Change) -> None:
    """Scores and states before and after, and the checks with another outcome."""
    scores = f"{points(change.raw_before)} -> {points(change.raw_after)}"
    if change.state_before != change.state_after:
        scores += f", {change.state_before} -> {change.state_after}"
    if change.overridden:
        scores += f"; the override stands at {points(change.score_after)}"
    elif (change.score_before, change.score_after) != (change.raw_before, change.raw_after):
        scores += f"; counting {points(change.score_before)} -> {points(change.score_after)}"
    console.item(f"{one_line(change.student)} {change.exercise}", scores)
    for check in change.checks:
        delta = f", {check.points_after - check.points_before:+g} points"
        console.item(
            check.id, f"{check.before or 'no such check'} -> {check.after or 'gone'}{delta}", indent=4
        )


def points(score: float | None) -> str:
    """A score in words; None is none."""
    return "no score" if score is None else format_points(score)
