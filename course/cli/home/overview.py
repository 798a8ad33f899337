"""``course`` and ``course progress``: where am I, what is next, what have I done, what have I learned."""

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from datetime import datetime
from functools import cache
from pathlib import Path

from course.catalog.load import Catalog
from course.catalog.models import Exercise
from course.cli.frame.console import Console, current
from course.cli.frame.here import Here, here_or_outside
from course.cli.frame.replies import NextStep, filled
from course.cli.home import replies
from course.cli.home.advice import exercise_ahead, next_in_course, why
from course.errors import CourseError
from course.printable import counted
from course.progress.history import History, Mistake, Standing
from course.reading.parts import Script, read_script
from course.reading.record import Prediction, predictions_of, tally
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
    all_of_it = f"{counted(len(lessons), 'lesson')}, {counted(len(exercises), 'exercise')}"
    console.line(f"{all_of_it}; all of it works offline.")
    console.line("You are not in a workspace: the folder that holds your own files.")
    console.note("See what it looks like first: course demo")
    console.next(step)
    return console.answer(
        replies.Status(
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
            replies.Progress,
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


def _show_reading(
    console: Console, lessons: Sequence[replies.LessonState], warm_ups: Sequence[replies.WarmUpState]
) -> None:
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


def warm_up_states(catalog: Catalog, standing: Standing) -> tuple[replies.WarmUpState, ...]:
    """Every warm-up and how far the student is; raises what reading the record raises."""
    states = []
    for number, one in enumerate(catalog.warm_ups(), start=1):
        history = standing.history(one.id)
        state = "done" if history.done else "started" if standing.is_begun(one.id) else "new"
        done_at = history.done.at.isoformat() if history.done else None
        more = {"checks_run": len(history.runs), "hints_shown": len(history.hints), "done_at": done_at}
        states.append(filled(replies.WarmUpState, one, number=number, state=state, **more))
    return tuple(states)


def _done_of(states: Sequence[replies.WarmUpState]) -> str:
    return f"{sum(state.state == 'done' for state in states)} of {len(states)} done"


def exercise_states(catalog: Catalog, standing: Standing) -> tuple[replies.ExerciseState, ...]:
    """Every exercise and how far the student is; raises what reading the record raises."""
    states = []
    for number, one in enumerate(catalog.exercises(), start=1):
        history = standing.history(one.id)
        graded, best, first_pass, last = history.last_graded, history.best, history.first_pass, history.last
        state = filled(
            replies.ExerciseState,
            one,
            number=number,
            chapter=one.number or None,
            state=_state(one.id in standing.started, history),
            score=graded.score if graded else None,
            max_score=graded.max_score if graded else None,
            best_score=best.score if best else None,
            checks_run=len(history.runs),
            hints_shown=len(history.hints),
            started_at=history.started.isoformat() if history.started else None,
            checked_at=last.at.isoformat() if last else None,
            passed_at=first_pass.at.isoformat() if first_pass else None,
        )
        states.append(state)
    return tuple(states)


def quiz_state(catalog: Catalog, standing: Standing) -> replies.QuizState | None:
    """The quiz, by the record; None if the course has none."""
    questions = len(list(catalog.content.quiz.glob("*.toml")))
    if not questions:
        return None
    best = standing.quiz.best
    if best is None:
        return replies.QuizState(attempts=0, best=None, total=questions, passed=False)
    return replies.QuizState(len(standing.quiz.counting), best.score, best.total, best.passed)


def lesson_states(catalog: Catalog, standing: Standing) -> tuple[replies.LessonState, ...]:
    """Every lesson and when it was first read; raises what reading the record raises."""
    read = {name: at.isoformat() for name, at in standing.read.items()}
    return tuple(filled(replies.LessonState, one, read_at=read.get(one.id)) for one in catalog.lessons())


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
        known = {one.id: f"{WORDS[one.state]} {score_of(one)}".rstrip() for one in states}
        evidence = {one.id: f"exercise {one.number}, {one.id}: {known[one.id]}" for one in states}
        show_objectives(objectives, evidence, taken=taken)
    elif states:
        rows = [(one.id, str(one.number), WORDS[one.state], score_of(one)) for one in states]
        console.table(("Exercise", "No.", "State", "Score"), rows)
    if here.workspace.version != catalog.version:
        versions = f"The course is at version {catalog.version}, this workspace at {here.workspace.version}"
        newer = here.workspace.is_newer(catalog.version)
        advice = "install the newer course" if newer else "course update --dry-run shows what is new"
        console.note(f"{versions}: {advice}.")
    if objectives:
        console.note("To play with: course sandbox")
    if ahead:
        console.note(ahead)
    goes = str(step) != "course doctor"  # nothing can be done before that
    console.note((f"Next: {step}", "bold"), " (`course go` runs it, and goes on from there)" if goes else "")
    return here.answer(
        replies.Status(
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


def _progress_line(exercise: replies.ExerciseState) -> str:
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


def _quiz_line(quiz: replies.QuizState) -> str:
    if quiz.best is None:
        return "not taken yet"
    parts = ["passed" if quiz.passed else "not passed yet", f"best {quiz.best} of {quiz.total}"]
    return ", ".join([*parts, counted(quiz.attempts, "attempt")])


def score_of(state: replies.ExerciseState) -> str:
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
    return here.answer(replies.Next(next=NextStep(step), why=reason))


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
        replies.Exercises(
            workspace=str(here.workspace.root) if here else None,
            exercises=states,
            next=NextStep(step) if step else None,
        )
    )


# ---
# The part of ``course progress`` about learning: predictions, mistakes, sections to read again.


#: So many days of predictions are shown; ``--json`` has all.
_DAYS = 7


class Learning:
    """A student's learning, by the record.

    Attributes:
        predictions: None if the student made no predictions.
        mistakes: in the order they were first made.
        revisit: sections worth reading again; those with the most mistakes come first.
    """

    def __init__(self, catalog: Catalog, standing: Standing) -> None:
        self._catalog = catalog
        self._scripts = cache(self._script)
        said = predictions_of(standing.events())
        self.predictions = self._predictions(said) if said else None
        self.mistakes = tuple(self._mistakes(standing.mistakes))
        self.revisit = tuple(self._revisit())

    def _predictions(self, said: Sequence[Prediction]) -> replies.PredictionsState:
        lessons = [one for one in self._catalog.lesson_ids() if any(each.lesson == one for each in said)]
        days = sorted({_day(one) for one in said})
        each = []
        for one in said:
            more = {"said": one.text or None, "at": one.at.isoformat(), **self._asked(one)}
            each.append(filled(replies.PredictionState, one, **more))
        return replies.PredictionsState(
            all=replies.PredictionsOf(of="all", **tally(said)),
            by_lesson=tuple(
                replies.PredictionsOf(of=one, **tally(x for x in said if x.lesson == one)) for one in lessons
            ),
            by_day=tuple(
                replies.PredictionsOf(of=one, **tally(x for x in said if _day(x) == one)) for one in days
            ),
            each=tuple(each),
        )

    def _script(self, lesson: str) -> Script | None:
        """The lesson; None if the course no longer has it."""
        try:
            return read_script(self._catalog.lesson(lesson))
        except CourseError:
            return None

    def _asked(self, said: Prediction) -> dict[str, str]:
        """Where it was asked, as "lesson#section", and the question; "" for what is gone."""
        script = self._scripts(said.lesson)
        asked = next((one for one in script.questions if one.key == said.key), None) if script else None
        section = script.section_of(asked.index) if script and asked else None
        where = f"{said.lesson}#{section.slug}" if section else ""
        return {"section": where, "question": asked.words if asked else ""}

    def _mistakes(self, made: Sequence[Mistake]) -> Iterable[replies.MistakeState]:
        known = {one.id: one for one in (*self._catalog.exercises(), *self._catalog.warm_ups())}
        for one in made:
            exercise = known.get(one.exercise)
            if exercise is None:
                continue
            yield filled(
                replies.MistakeState,
                one,
                title=exercise.task_called(one.task).title,
                looks_like=_looks_like(exercise, one),
                read=exercise.where_to_read(one.task),
                first_seen=one.first.isoformat(),
                last_seen=one.last.isoformat(),
                mended_at=one.mended.isoformat() if one.mended else None,
                given=one.diagnosis in {task.fault for task in exercise.task if task.id == one.task},
            )

    def _revisit(self) -> Iterable[replies.Revisit]:
        why: dict[str, list[str]] = {}
        for one in self.mistakes:
            if one.named:
                why.setdefault(one.read, []).append(f"{one.task} in {one.exercise}: {one.diagnosis}")
        said = self.predictions.each if self.predictions is not None else ()
        wrong = Counter(each.section for each in said if each.judged == "wrong" and each.section)
        for place, count in wrong.items():
            often = "a prediction was" if count == 1 else f"{count} predictions were"
            why.setdefault(place, []).append(f"{often} wrong")
        for place, reasons in sorted(why.items(), key=lambda item: -len(item[1])):
            named = {"lesson": place.partition("#")[0], "title": self._title(place)}
            yield replies.Revisit(
                **named, section=place, why=tuple(reasons), command=f"course lesson {place}"
            )

    def _title(self, place: str) -> str:
        """The section's title; the lesson's where there is no such section."""
        lesson, _, slug = place.partition("#")
        script = self._scripts(lesson)
        if script is None:
            return place
        return next((one.title for one in script.sections if one.slug == slug), script.lesson.title)


def show_learning(console: Console, learning: Learning) -> None:
    """Print what there is; nothing for a student who predicted nothing and made no mistake."""
    if (said := learning.predictions) is not None:
        console.heading("Predictions", f"{said.all.said} made, {said.all.skipped} skipped")
        days = said.by_day[-_DAYS:]
        for one in (*said.by_lesson, *(days if len(days) > 1 else ())):
            numbers = (one.right, one.nearly, one.wrong, one.unjudged, one.skipped)
            named = zip(numbers, ("right", "nearly right", "wrong", "not compared", "skipped"), strict=True)
            words = ", ".join(f"{number} {word}" for number, word in named if number)
            console.line(f"{one.of}: {words}", indent=2)
    made, given = ([one for one in learning.mistakes if one.given == of] for of in (False, True))
    _show_mistakes(console, "Mistakes", "made", made)
    _show_mistakes(console, "Faults in the programs you were given", "found by a check", given)
    if learning.revisit:
        console.heading("To read again")
        for place in learning.revisit:
            console.line(f"{place.title} ({_reasons(learning, place.section)})", indent=2)
            console.line((place.command, "dim"), indent=4)


def _reasons(learning: Learning, section: str) -> str:
    """Why to read a section again: the functions with open mistakes, by exercise, and wrong predictions."""
    tasks: dict[str, list[str]] = {}
    for one in learning.mistakes:
        if one.named and one.read == section and one.task not in tasks.get(one.exercise, ()):
            tasks.setdefault(one.exercise, []).append(one.task)
    reasons = [f"{exercise}: {', '.join(names)}" for exercise, names in tasks.items()]
    said = learning.predictions.each if learning.predictions is not None else ()
    wrong = sum(one.judged == "wrong" and one.section == section for one in said)
    if wrong:
        reasons.append("a wrong prediction" if wrong == 1 else f"{wrong} wrong predictions")
    return "; ".join(reasons)


#: So many mistakes that checks still name and so many others are shown, the newest of each.
_NAMED, _PAST = 5, 3


def _show_mistakes(console: Console, what: str, done: str, mistakes: Sequence[replies.MistakeState]) -> None:
    """How many, and each with the day it was made or fixed."""
    if not mistakes:
        return
    fixed = sum(one.mended_at is not None for one in mistakes)
    console.heading(what, f"{len(mistakes)} {done}, {fixed} fixed")
    shown = [one for one in mistakes if one.named][-_NAMED:]
    shown += [one for one in mistakes if not one.named][-_PAST:]
    for one in (one for one in mistakes if one in shown):
        seen = f"in {one.runs} checks since" if one.runs > 1 else "seen"
        state = "not fixed yet" if one.named else "not named any more"
        state = f"{state}, {seen} {day(one.first_seen)}"
        state = f"fixed {day(one.mended_at)}" if one.mended_at else state
        # A diagnosis of a check's own code has no words here; its name is made of words.
        words = one.looks_like or f"{one.diagnosis.replace('_', ' ').capitalize()}."
        console.line(f"{one.title} ({one.exercise}), {state}: {words}", indent=2)
    if len(shown) < len(mistakes):
        console.line(f"And {len(mistakes) - len(shown)} more, in `course progress --json`.", indent=2)


def _looks_like(exercise: Exercise, mistake: Mistake) -> str:
    """The diagnosis in words; "" where the exercise keeps none as data."""
    from course.scoring.explain.story import read_table

    table = read_table(Path(exercise.folder))
    entry = table.words.get(mistake.diagnosis) if table else None
    # Records of earlier versions do not say which exception it was.
    raised = f"Raised {mistake.raised.rstrip(' .') or 'an exception'}."
    return (entry.looks_like if entry else "") or (raised if mistake.diagnosis == "RAISED" else "")


def _day(said: Prediction) -> str:
    return said.at.astimezone().strftime("%Y-%m-%d")


def day(moment: str) -> str:
    """The local date and time of an ISO moment, to the minute."""
    return datetime.fromisoformat(moment).astimezone().strftime("%Y-%m-%d %H:%M")


# ---
# The learning objectives, with the evidence that each was reached.


def objective_states(
    catalog: Catalog,
    standing: Standing,
    states: Sequence[replies.ExerciseState],
    warm_ups: Sequence[replies.WarmUpState],
) -> tuple[replies.ObjectiveState, ...]:
    """The evidence for each objective; raises what reading the record raises."""
    said = [event for event in standing.events("prediction") if event.data.get("text")]
    predicted = {(event.subject, event.data.get("key")) for event in said}
    passed = {state.id for state in states if state.passed_at is not None}
    rights = [attempt.right.items() for attempt in standing.quiz.counting]
    answered = {question for items in rights for question, right in items if right}
    return tuple(
        filled(
            replies.ObjectiveState,
            one,
            lessons_read=tuple(name for name in one.lessons if name in standing.read),
            predictions=sum(lesson in one.lessons for lesson, _ in predicted),
            warm_ups=sum(state.lesson in one.lessons for state in warm_ups),
            warm_ups_done=sum(state.lesson in one.lessons and state.state == "done" for state in warm_ups),
            passed=tuple(name for name in one.exercises if name in passed),
            questions=one.quiz,
            answered=tuple(name for name in one.quiz if name in answered),
        )
        for one in catalog.syllabus.objective
    )


def show_objectives(
    objectives: Sequence[replies.ObjectiveState], exercises: Mapping[str, str], *, taken: bool
) -> None:
    """Each objective with its evidence.

    Args:
        exercises: the line about each exercise, by id.
        taken: the quiz was taken, so there is something to say of it.
    """
    console = current()
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
