"""Which command to suggest next."""

from __future__ import annotations

from pathlib import Path

from course.catalog.models import Exercise
from course.cli.frame.here import Here
from course.errors import CourseError
from course.progress.history import fingerprint
from course.progress.quiz import quiz_history
from course.scoring.verdict import Verdict, format_points, in_points

__all__ = [
    "after_report",
    "after_warm_up",
    "exercise_ahead",
    "hint_is_due",
    "next_in_course",
    "next_step",
]


def next_step(here: Here, exercise: Exercise, verdict: Verdict, source: bytes) -> str:
    """After a check: hand in, take a hint if one is due, or go on working."""
    if verdict.all_pass:
        return after_warm_up(here, exercise) if exercise.is_warm_up else "course submit"
    if fingerprint(source) == fingerprint(here.stub(exercise)):
        return _before_writing(here, exercise)
    return f"course {'hint' if hint_is_due(here, exercise) else 'watch'} {exercise.id}"


def hint_is_due(here: Here, exercise: Exercise) -> bool:
    """Whether ``course hint`` would give a new one; not where the record cannot be read."""
    try:
        return here.history(exercise).hint_is_due(fingerprint(here.stub(exercise)))
    except CourseError:
        return False


def after_warm_up(here: Here, warm_up: Exercise) -> str:
    """After a finished warm-up: its report, or what comes next."""
    if (Path(warm_up.folder) / "report.py").is_file():
        return f"course report {warm_up.id}"
    return _rest_of_lesson(here, warm_up)


def after_report(here: Here, exercise: Exercise) -> str:
    """Its checks; once they pass, what comes after the exercise."""
    try:
        last = here.history(exercise).last_graded
    except CourseError:
        last = None
    if last is None or not last.all_pass:
        return f"course check {exercise.id}"
    return _rest_of_lesson(here, exercise) if exercise.is_warm_up else "course submit"


def _rest_of_lesson(here: Here, warm_up: Exercise) -> str:
    """Its lesson if partly read; otherwise the lesson's next warm-up, the lesson, or what comes next."""
    try:
        begun = here.workspace.store.events("bookmark", warm_up.lesson)
        done = {e.subject for e in here.workspace.store.events("check") if e.data.get("all_pass")}
        read = any(event.subject == warm_up.lesson for event in here.workspace.store.events("lesson"))
    except CourseError:
        begun, done, read = (), set(), False
    if begun and not read:  # the other warm-ups wait there, each in its place
        return f"course lesson {warm_up.lesson}"
    left = [one.id for one in here.catalog.warm_ups(warm_up.lesson) if one.id not in {*done, warm_up.id}]
    if left:
        return f"course warmup {left[0]}"
    return next_in_course(here) if read else f"course lesson {warm_up.lesson}"


def next_in_course(here: Here) -> str:
    """From anywhere: the first lesson unread or exercise unfinished, in the order of the syllabus."""
    catalog = here.catalog
    read = {event.subject for event in here.workspace.store.events("lesson")}
    started = set(here.workspace.started())
    done: set[str] = set()
    # Warm-ups are offered where the student is now; moving on leaves the rest of them behind.
    furthest = next((name for name in reversed(catalog.lesson_ids()) if name in read), "")
    for lesson in catalog.lessons():
        if lesson.id not in read and not set(lesson.exercises) & started:
            return f"course lesson {lesson.id}"
        if lesson.id in read and not set(lesson.exercises) & started and lesson.id == furthest:
            step = _warm_up_step(here, lesson.id, started)
            if step:
                return step
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


def exercise_ahead(here: Here, step: str) -> str:
    """The exercise in progress, or where the next one comes, while ``step`` is about a lesson; else empty."""
    catalog, (_, kind, *names) = here.catalog, step.split()
    a_warm_up = bool(names) and names[0] in catalog.warm_up_ids()
    if kind != "lesson" and not a_warm_up:
        return ""
    if going := _in_progress(here):
        return going
    started = set(here.workspace.started())
    ahead = (one for one in catalog.exercises() if one.id not in started and here.history(one).last is None)
    exercise = next(ahead, None)
    if exercise is None or exercise.lesson not in catalog.lesson_ids():
        return ""
    after = catalog.lesson_ids().index(exercise.lesson) + 1
    called = f"Exercise {exercise.number}, {exercise.id}," if exercise.number else f"Exercise {exercise.id}"
    return f"{called} comes after lesson {after}. To start it now: course start {exercise.id}"


def _in_progress(here: Here) -> str:
    """The exercise checked last, of those begun and not done, and how to go on; empty without one."""
    begun: list[tuple[str, str]] = []
    started = set(here.workspace.started())
    for exercise in here.catalog.exercises():
        history = here.history(exercise)
        last, graded = history.last, history.last_graded
        if (last is None and exercise.id not in started) or (graded is not None and graded.all_pass):
            continue
        points = graded and f"{format_points(graded.score)} of {in_points(graded.max_score)}"
        state = f"in progress, {points}" if points else "started, not checked yet"
        go_on = f"{exercise.id}: {state}. To go on: course check {exercise.id}"
        begun.append((last.at.isoformat() if last else "", go_on))
    return max(begun, key=lambda one: one[0])[1] if begun else ""


def _warm_up_step(here: Here, lesson: str, started: set[str]) -> str:
    """The first warm-up of a lesson that is not done; empty if there is none."""
    for warm_up in here.catalog.warm_ups(lesson):
        if not any(run.all_pass and not run.only for run in here.history(warm_up).runs):
            return f"course {'check' if warm_up.id in started else 'warmup'} {warm_up.id}"
    return ""


def _quiz_passed(here: Here) -> bool:
    """Whether the student has passed the quiz, or the course has none."""
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
    """The step before anything is written: the lesson if it was not read, or the file."""
    if exercise.is_warm_up:  # done while its lesson is read
        return f"course watch {exercise.id}"
    try:
        read = any(event.subject == exercise.lesson for event in here.workspace.store.events("lesson"))
    except CourseError:
        read = True
    return f"course watch {exercise.id}" if read else f"course lesson {exercise.lesson}"
