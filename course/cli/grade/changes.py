"""A change of a student's result, and what was kept about it, as a terminal shows them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import msgspec

from course.printable import one_line
from course.scoring.numbers import format_points

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from course.cli.frame.terminal.console import Console
    from course.grading.results.journal import ScoreChange
    from course.grading.running.rerun import Change

__all__ = ["in_words", "moved_scores", "points", "show_change", "show_roster"]

#: Characters of what a decision keeps, and scores of a class, that one line names; students in a list.
_SHOWN, _FEW, _MOST = 200, 5, 20


def show_change(console: Console, change: Change) -> None:
    """Scores and states before and after, and the checks with another outcome."""
    old, new = change.max_before, change.max_after
    scores = f"{points(change.raw_before, old)} -> {points(change.raw_after, new)}"
    if change.state_before != change.state_after:
        scores += f", {change.state_before} -> {change.state_after}"
    if change.overridden:
        scores += f"; the override stands at {points(change.score_after, new)}"
    elif (change.score_before, change.score_after) != (change.raw_before, change.raw_after):
        scores += f"; counting {points(change.score_before, old)} -> {points(change.score_after, new)}"
    console.item(f"{one_line(change.student)} {change.exercise}", scores)
    if change.raw_before is None or change.raw_after is None:
        return  # of what no check judged, none has changed
    for check in change.checks:
        delta = f", {check.points_after - check.points_before:+g} points"
        console.item(
            check.id, f"{check.before or 'no such check'} -> {check.after or 'gone'}{delta}", indent=4
        )


def moved_scores(moved: Sequence[ScoreChange]) -> Iterator[str]:
    """Whose score changes, and how, one line each."""
    for one in moved[:_MOST]:
        scores = f"{points(one.before, one.max_before)} -> {points(one.after, one.max_after)}"
        yield f"{one_line(one.student)} {one.exercise}: {scores}"
    if len(moved) > _MOST:
        yield f"and {len(moved) - _MOST} more"


def show_roster(console: Console, file: str, moved: Sequence[ScoreChange], dropped: Sequence[str]) -> None:
    """What a roster changes, if anything: scores, and who is enrolled."""
    if moved:
        scores = "1 score changes" if len(moved) == 1 else f"{len(moved)} scores change"
        console.line((f"With {file}, {scores}:", "bold"))
    for line in moved_scores(moved):
        console.line(line, indent=2)
    if dropped:
        leave = (
            f"1 student is not in {file} and leaves"
            if len(dropped) == 1
            else f"{len(dropped)} students are not in {file} and leave"
        )
        more = f" and {len(dropped) - _MOST} more" if dropped[_MOST:] else ""
        console.line(f"{leave} the roster: {', '.join(map(one_line, dropped[:_MOST]))}{more}")


def points(score: float | None, most: float | None = None) -> str:
    """A score in words, beside the points there are where that is known; None is none."""
    if score is None:
        return "no score"
    return format_points(score) + ("" if most is None else f" of {format_points(most)}")


def in_words(text: str) -> str:
    """What counted, as a decision keeps it, for a person: a score, and why there was none."""
    try:
        kept = msgspec.json.decode(text)
    except msgspec.DecodeError:
        kept = text
    if isinstance(kept, dict):
        score = kept.get("score")
        why = kept.get("reason") or (kept.get("state") if score is None else "")
        words = (points(score, kept.get("of")), str(why or ""), str(kept.get("file", "")))
        return one_line(", ".join(filter(None, words)))
    if isinstance(kept, list):  # of a class: student, exercise, score
        shown = [f"{student} {exercise} {points(score)}" for student, exercise, score in kept[:_FEW]]
        return one_line("; ".join(shown + ["..."] * (len(kept) > _FEW)))
    return one_line(str(kept)[:_SHOWN])
