"""``course exercises``: the list of them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from course.cli.frame.here import find_workspace, load_catalog
from course.cli.frame.replies import NextStep
from course.cli.frame.terminal.console import current
from course.cli.home.overview import WORDS, exercise_state, score_of
from course.cli.home.replies import Exercises, ExerciseState

if TYPE_CHECKING:
    from course.catalog.models import Exercise

__all__ = ["exercises"]


def exercises() -> int:
    """List the exercises.

    In the order in which the lessons lead to them. The numbers are the chapter's: `course start 2` and
    `course check 2` take them as well as ids.
    """
    console, here = current(), find_workspace()
    catalog = here.catalog if here else load_catalog()
    states = tuple(
        exercise_state(here, exercise) if here else _unknown(exercise) for exercise in catalog.exercises()
    )
    for state in states:
        known = f"; {WORDS[state.state]} {score_of(state)}".rstrip() if here else ""
        console.item(
            str(state.number or "ours"),
            (state.id, "bold"),
            f": {state.title}; lesson {state.lesson}{known}",
            indent=0,
            width=4,
        )
    console.note(
        "In the order of the lessons. A number is the chapter's; what is `ours` has none and is called by "
        "its name."
    )
    left = next((state for state in states if state.state not in {"passed", "complete"}), None)
    step = f"course start {left.id}" if left is not None and left.state == "new" else ""
    if left is not None and not step:
        step = f"course watch {left.id}"
    if step:
        console.note(f"Next: {step}" if here else f"In a workspace (course init): {step}")
    console.emit(
        Exercises(
            workspace=str(here.workspace.root) if here else None,
            exercises=states,
            next=NextStep(step) if step else None,
        )
    )
    return 0


def _unknown(exercise: Exercise) -> ExerciseState:
    """An exercise outside of a workspace."""
    return ExerciseState(
        id=exercise.id,
        title=exercise.title,
        summary=exercise.summary,
        lesson=exercise.lesson,
        number=exercise.number or None,
        state="new",
    )
