"""``course`` and ``course progress``: where am I, what is next, what have I done."""

from collections.abc import Sequence

from course.catalog.load import Catalog
from course.catalog.models import Exercise
from course.cli.frame.console import Console, current
from course.cli.frame.here import Here, here_or_outside
from course.cli.frame.replies import NextStep, filled
from course.cli.home.advice import exercise_ahead, next_in_course, why
from course.cli.home.learning import Learning, day, objective_states, show_learning, show_objectives
from course.cli.home.replies import (
    Exercises,
    ExerciseState,
    LessonState,
    Next,
    Progress,
    QuizState,
    Status,
    WarmUpState,
)
from course.errors import CourseError
from course.printable import counted
from course.progress.history import History, Standing
from course.scoring.verdict import format_points

#: States of an exercise, as a person reads them.
WORDS = {
    "new": "not started",
    "started": "started, not checked yet",
    "broken": "could not be run at the last check",
    "failing": "in progress",
    "passed": "passed",
    "complete": "every public check passes",
}


def dashboard() -> int:
    """Say where the student is and what is next."""
    console, (here, catalog) = current(), here_or_outside()
    if here is not None:
        return _inside(console, here)
    lessons, exercises = catalog.lesson_ids(), catalog.exercise_ids()
    step = "course init my-course"
    console.heading(catalog.title)
    console.line(
        f"{counted(len(lessons), 'lesson')}, {counted(len(exercises), 'exercise')}; all of it works offline."
    )
    console.line("You are not in a workspace: the folder that holds your own files.")
    console.note("See what it looks like first: course demo")
    console.next(step)
    return console.answer(
        Status(
            course=catalog.ref,
            title=catalog.title,
            workspace=None,
            lessons_read=0,
            lessons=len(lessons),
            exercises=(),
            next=NextStep(step),
        )
    )


def progress() -> int:
    """Show everything done so far.

    Lessons read, exercises checked, with dates and scores; what you predicted and how well, which mistakes
    you made and fixed, and what to read again.
    """
    console, here = current(), Here.load()
    catalog, standing = here.catalog, here.standing()
    exercises, lessons = exercise_states(catalog, standing), lesson_states(catalog, standing)
    sent = tuple(event.at.isoformat() for event in standing.events("submit"))
    warm_ups, quiz = warm_up_states(catalog, standing), quiz_state(catalog, standing)
    learning = Learning(catalog, standing)
    with console.paged():
        _show_reading(console, lessons, warm_ups)
        done = sum(x.state in {"passed", "complete"} for x in exercises)
        console.heading("Exercises", f"{done} of {len(exercises)} passed")
        for exercise in exercises:
            name = f"{exercise.number}. {exercise.title} ({exercise.id})"
            console.line(f"{name}: {_progress_line(exercise)}", indent=2)
        if quiz is not None:
            console.heading("Quiz", _quiz_line(quiz))
        often = counted(len(sent), "time")
        console.heading("Handed in", f"{often}, last {day(sent[-1])}" if sent else "never")
        show_learning(console, learning)
    step = next_in_course(catalog, standing)
    console.next(step)
    return here.answer(
        filled(
            Progress,
            learning,
            course=here.course,
            workspace=str(here.workspace.root),
            lessons=lessons,
            exercises=exercises,
            submissions=sent,
            next=NextStep(step),
            quiz=quiz,
            warm_ups=warm_ups,
        )
    )


def _show_reading(console: Console, lessons: Sequence[LessonState], warm_ups: Sequence[WarmUpState]) -> None:
    """A line for each lesson that was read, or has a warm-up that was begun."""
    console.heading("Lessons", f"{sum(x.read_at is not None for x in lessons)} of {len(lessons)} read")
    if warm_ups:
        console.heading("Warm-ups", _done_of(warm_ups))
    for lesson in lessons:
        ours = [state for state in warm_ups if state.lesson == lesson.id]
        begun = any(state.state != "new" for state in ours)
        if lesson.read_at or begun:
            when = f"read {day(lesson.read_at)}" if lesson.read_at else "not read to the end"
            small = f", warm-ups {_done_of(ours)}" if begun else ""
            title = lesson.title.partition(":")[0]
            console.line(f"{title} ({lesson.id}): {when}{small}", indent=2)


def warm_up_states(catalog: Catalog, standing: Standing) -> tuple[WarmUpState, ...]:
    """Every warm-up and how far the student is; raises what reading the record raises."""
    states = []
    for number, one in enumerate(catalog.warm_ups(), start=1):
        history = standing.history(one.id)
        state = "done" if history.done else "started" if standing.is_begun(one.id) else "new"
        done_at = history.done.at.isoformat() if history.done else None
        more = {"checks_run": len(history.runs), "hints_shown": len(history.hints), "done_at": done_at}
        states.append(filled(WarmUpState, one, number=number, state=state, **more))
    return tuple(states)


def _done_of(states: Sequence[WarmUpState]) -> str:
    return f"{sum(state.state == 'done' for state in states)} of {len(states)} done"


def exercise_states(catalog: Catalog, standing: Standing) -> tuple[ExerciseState, ...]:
    """Every exercise and how far the student is; raises what reading the record raises."""
    return tuple(_exercise_state(one, n, standing) for n, one in enumerate(catalog.exercises(), start=1))


def _exercise_state(exercise: Exercise, number: int, standing: Standing) -> ExerciseState:
    history = standing.history(exercise.id)
    graded, best, first_pass, last = history.last_graded, history.best, history.first_pass, history.last
    return filled(
        ExerciseState,
        exercise,
        number=number,
        chapter=exercise.number or None,
        state=_state(exercise.id in standing.started, history),
        score=graded.score if graded else None,
        max_score=graded.max_score if graded else None,
        best_score=best.score if best else None,
        checks_run=len(history.runs),
        hints_shown=len(history.hints),
        started_at=history.started.isoformat() if history.started else None,
        checked_at=last.at.isoformat() if last else None,
        passed_at=first_pass.at.isoformat() if first_pass else None,
    )


def quiz_state(catalog: Catalog, standing: Standing) -> QuizState | None:
    """The quiz, by the record; None if the course has none."""
    questions = len(list(catalog.content.quiz.glob("*.toml")))
    if not questions:
        return None
    best = standing.quiz.best
    if best is None:
        return QuizState(attempts=0, best=None, total=questions, passed=False)
    return QuizState(len(standing.quiz.counting), best.score, best.total, best.passed)


def lesson_states(catalog: Catalog, standing: Standing) -> tuple[LessonState, ...]:
    """Every lesson and when it was first read; raises what reading the record raises."""
    return tuple(
        filled(LessonState, lesson, read_at=at.isoformat() if (at := standing.read.get(lesson.id)) else None)
        for lesson in catalog.lessons()
    )


def _state(started: bool, history: History) -> str:
    last, whole = history.last, history.last_graded
    if last is None:
        return "started" if started else "new"
    if last.state != "graded":
        return "broken"
    if whole is not None and whole.all_pass and last.all_pass:
        return "complete"
    return "passed" if whole is not None and whole.passed else "failing"  # or only some checks were ever run


def _inside(console: Console, here: Here) -> int:
    catalog = here.catalog
    try:
        standing = here.standing()
        states, quiz = exercise_states(catalog, standing), quiz_state(catalog, standing)
        read = sum(lesson.read_at is not None for lesson in lesson_states(catalog, standing))
        warm_ups = warm_up_states(catalog, standing)
        objectives = objective_states(catalog, standing, states, warm_ups)
        step = next_in_course(catalog, standing)
        ahead = exercise_ahead(catalog, standing, step)
    except CourseError as error:
        # A student in trouble looks at the dashboard first, so it must not fail as well.
        here.warnings.append(f"{error.message} {error.help}")
        states, read, quiz, warm_ups, objectives, step, ahead = (), 0, None, (), (), "course doctor", ""
    total = len(catalog.lesson_ids())
    console.heading(catalog.title)
    console.line(f"Workspace: {here.workspace.root}")
    done = [f"Lessons read: {read} of {total}"]
    done += [f"warm-ups: {_done_of(warm_ups)}"] if warm_ups else []
    done += [f"quiz: {_quiz_line(quiz)}"] if quiz is not None else []
    console.line("; ".join(done))
    if objectives:
        taken = quiz is not None and quiz.best is not None
        evidence = {
            state.id: f"exercise {state.number}, {state.id}: {WORDS[state.state]} {score_of(state)}".rstrip()
            for state in states
        }
        show_objectives(console, objectives, evidence, taken=taken)
    elif states:
        console.table(
            ("Exercise", "No.", "State", "Score"),
            [(state.id, str(state.number), WORDS[state.state], score_of(state)) for state in states],
        )
    if here.workspace.version != catalog.version:
        console.note(
            f"The course is at version {catalog.version}, this workspace at {here.workspace.version}: "
            "course update --dry-run shows what is new."
        )
    if objectives:
        console.note("To play with: course sandbox")
    if ahead:
        console.note(ahead)
    goes = str(step) != "course doctor"  # nothing can be done before that
    console.note((f"Next: {step}", "bold"), " (`course go` runs it, and goes on from there)" if goes else "")
    return here.answer(
        Status(
            course=here.course,
            title=catalog.title,
            workspace=str(here.workspace.root),
            lessons_read=read,
            lessons=total,
            exercises=states,
            next=NextStep(step),
            quiz=quiz,
            objectives=objectives,
            warnings=tuple(here.warnings),
        )
    )


def _progress_line(exercise: ExerciseState) -> str:
    parts = [WORDS[exercise.state]]
    if exercise.score is not None and exercise.max_score is not None:
        parts.append(f"score {score_of(exercise)}")
        if exercise.best_score is not None and exercise.best_score > exercise.score:
            parts.append(f"best {format_points(exercise.best_score)}")
    if exercise.checks_run:
        parts.append(f"checked {counted(exercise.checks_run, 'time')}")
    if exercise.hints_shown:
        parts.append(counted(exercise.hints_shown, "hint"))
    if exercise.passed_at:
        parts.append(f"first passed {day(exercise.passed_at)}")
    elif exercise.checked_at:
        parts.append(f"last checked {day(exercise.checked_at)}")
    elif exercise.started_at:
        parts.append(f"since {day(exercise.started_at)}")
    return ", ".join(parts)


def _quiz_line(quiz: QuizState) -> str:
    if quiz.best is None:
        return "not taken yet"
    parts = ["passed" if quiz.passed else "not passed yet", f"best {quiz.best} of {quiz.total}"]
    return ", ".join([*parts, counted(quiz.attempts, "attempt")])


def score_of(state: ExerciseState) -> str:
    """Points of the last check; empty before one."""
    if state.score is None or state.max_score is None:
        return ""
    return f"{format_points(state.score)}/{format_points(state.max_score)}"


def next_command() -> int:
    """Name what is next, and open nothing.

    `course go` does it.
    """
    console, here = current(), Here.load()
    step = next_in_course(here.catalog, here.standing())
    console.line(step)
    console.note((reason := why(here.catalog, step), "dim"))
    return here.answer(Next(next=NextStep(step), why=reason))


# ---
# ``course exercises``: the list of them.


def exercises() -> int:
    """List the exercises.

    In the order in which the lessons lead to them, which their numbers follow: `course start 2` and
    `course check 2` take them as well as ids.
    """
    console, (here, catalog) = current(), here_or_outside()
    states = exercise_states(catalog, here.standing() if here else Standing())
    for state in states:
        chapter = f"the chapter's {state.chapter}" if state.chapter else "ours, not the chapter's"
        known = f"; {WORDS[state.state]} {score_of(state)}".rstrip() if here else ""
        words = f": {state.title}; lesson {state.lesson}; {chapter}{known}"
        console.item(str(state.number), (state.id, "bold"), words, indent=0, width=2)
    left = next((state for state in states if state.state not in {"passed", "complete"}), None)
    step = f"course {'start' if left.state == 'new' else 'watch'} {left.id}" if left else ""
    if step:
        console.note(f"Next: {step}" if here else f"In a workspace (course init): {step}")
    return console.answer(
        Exercises(
            workspace=str(here.workspace.root) if here else None,
            exercises=states,
            next=NextStep(step) if step else None,
        )
    )
