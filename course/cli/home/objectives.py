"""The learning objectives, with the evidence that each was reached."""

from __future__ import annotations

from typing import TYPE_CHECKING

from course.cli.home.replies import ExerciseState, ObjectiveState, WarmUpState
from course.progress.quiz import quiz_history

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from course.cli.frame.here import Here
    from course.cli.frame.terminal.console import Console

__all__ = ["objective_states", "show_objectives"]


def objective_states(
    here: Here, states: Sequence[ExerciseState], warm_ups: Sequence[WarmUpState]
) -> tuple[ObjectiveState, ...]:
    """The evidence for each objective; raises what reading the record raises."""
    events = here.workspace.store.events()
    read = {event.subject for event in events if event.kind == "lesson"}
    predicted = {
        (event.subject, event.data.get("key"))
        for event in events
        if event.kind == "prediction" and event.data.get("text")
    }
    passed = {state.id for state in states if state.passed_at is not None}
    answered = {
        question
        for attempt in quiz_history(events).counting
        for question, right in attempt.right.items()
        if right
    }
    return tuple(
        ObjectiveState(
            title=one.title,
            lessons=one.lessons,
            lessons_read=tuple(name for name in one.lessons if name in read),
            predictions=sum(lesson in one.lessons for lesson, _ in predicted),
            warm_ups=sum(state.lesson in one.lessons for state in warm_ups),
            warm_ups_done=sum(state.lesson in one.lessons and state.state == "done" for state in warm_ups),
            exercises=one.exercises,
            passed=tuple(name for name in one.exercises if name in passed),
            questions=one.quiz,
            answered=tuple(name for name in one.quiz if name in answered),
        )
        for one in here.catalog.syllabus.objective
    )


def show_objectives(
    console: Console, objectives: Sequence[ObjectiveState], exercises: Mapping[str, str], *, taken: bool
) -> None:
    """Each objective with its evidence.

    Args:
        exercises: the line about each exercise, by id.
        taken: the quiz was taken, so there is something to say of it.
    """
    console.heading("After this course you can …")
    for number, one in enumerate(objectives, 1):
        console.item(str(number), one.title)
        facts = [f"lessons read: {len(one.lessons_read)} of {len(one.lessons)}"]
        facts.append(f"predictions: {one.predictions}")
        if one.warm_ups:
            facts.append(f"warm-ups: {one.warm_ups_done} of {one.warm_ups}")
        if one.questions and taken:
            facts.append(f"quiz: {len(one.answered)} of {len(one.questions)} right")
        console.line((", ".join(facts), "dim"), indent=5)
        for name in one.exercises:
            if name in exercises:
                console.line((exercises[name], "dim"), indent=5)
