"""Which command to suggest next."""

from __future__ import annotations

from typing import TYPE_CHECKING

from course.errors import CourseError
from course.progress.history import fingerprint
from course.progress.quiz import quiz_history

if TYPE_CHECKING:
    from course.catalog.models import Exercise
    from course.cli.frame.here import Here
    from course.scoring.verdict import Verdict

__all__ = ["next_in_course", "next_step"]


def next_step(here: Here, exercise: Exercise, verdict: Verdict, source: bytes) -> str:
    """After a check: hand in, take a hint if one is due, or go on working."""
    if verdict.all_pass:
        return "course submit"
    stub = fingerprint(here.stub(exercise))
    if fingerprint(source) == stub:
        return _before_writing(here, exercise)
    try:
        due = here.history(exercise).hint_is_due(stub)
    except CourseError:
        due = False
    return f"course hint {exercise.id}" if due else f"course watch {exercise.id}"


def next_in_course(here: Here) -> str:
    """From anywhere: the first lesson unread or exercise unfinished, in the order of the syllabus."""
    catalog = here.catalog
    read = {event.subject for event in here.workspace.store.events("lesson")}
    started = set(here.workspace.started())
    done: set[str] = set()
    for lesson in catalog.lessons():
        if lesson.id not in read and not set(lesson.exercises) & started:
            return f"course lesson {lesson.id}"
        for name in lesson.exercises:
            done.add(name)
            step = _exercise_step(here, name, started)
            if step:
                return step
    for exercise in catalog.exercises():
        step = "" if exercise.id in done else _exercise_step(here, exercise.id, started)
        if step:
            return step
    if not started:
        return "course lessons"
    return "course submit" if _quiz_passed(here) else "course quiz take"


def _quiz_passed(here: Here) -> bool:
    """Whether the quiz is behind the student, or the course has none."""
    if not any(here.catalog.content.quiz.glob("*.toml")):
        return True

    best = quiz_history(here.workspace.store.events()).best
    return best is not None and best.passed


def _exercise_step(here: Here, name: str, started: set[str]) -> str:
    if name not in here.catalog.exercise_ids():
        return ""
    history = here.history(here.catalog.exercise(name))
    if name not in started and history.last is None:  # a notebook needs no start
        return f"course start {name}"
    last = history.last_graded
    return "" if last is not None and last.all_pass else f"course check {name}"


def _before_writing(here: Here, exercise: Exercise) -> str:
    """Nothing is written yet: the lesson, if it was not read, or the file."""
    try:
        read = any(event.subject == exercise.lesson for event in here.workspace.store.events("lesson"))
    except CourseError:
        read = True
    return f"course watch {exercise.id}" if read else f"course lesson {exercise.lesson}"
