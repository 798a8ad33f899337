"""The part of ``course progress`` about learning: predictions, mistakes, sections to read again."""

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from datetime import datetime
from functools import cache
from pathlib import Path

from course.catalog.load import Catalog
from course.catalog.models import Exercise
from course.cli.frame.console import Console
from course.cli.frame.replies import filled
from course.cli.home.replies import (
    ExerciseState,
    MistakeState,
    ObjectiveState,
    PredictionsOf,
    PredictionsState,
    PredictionState,
    Revisit,
    WarmUpState,
)
from course.errors import CourseError
from course.progress.history import Mistake, Standing
from course.reading.parts import Script, read_script
from course.reading.record import RecordedPrediction, predictions_of, tally

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

    # -- predictions -----------------------------------------------------------------------------------

    def _predictions(self, said: Sequence[RecordedPrediction]) -> PredictionsState:
        lessons = [one for one in self._catalog.lesson_ids() if any(each.lesson == one for each in said)]
        days = sorted({_day(one) for one in said})
        each = []
        for one in said:
            more = {"said": one.text or None, "at": one.at.isoformat(), **self._asked(one)}
            each.append(filled(PredictionState, one, **more))
        return PredictionsState(
            all=PredictionsOf(of="all", **tally(said)),
            by_lesson=tuple(
                PredictionsOf(of=one, **tally(x for x in said if x.lesson == one)) for one in lessons
            ),
            by_day=tuple(PredictionsOf(of=one, **tally(x for x in said if _day(x) == one)) for one in days),
            each=tuple(each),
        )

    def _script(self, lesson: str) -> Script | None:
        """The lesson; None if the course no longer has it."""
        try:
            return read_script(self._catalog.lesson(lesson))
        except CourseError:
            return None

    def _asked(self, said: RecordedPrediction) -> dict[str, str]:
        """Where it was asked, as "lesson#section", and the question; "" for what is gone."""
        script = self._scripts(said.lesson)
        asked = next((one for one in script.questions if one.key == said.key), None) if script else None
        section = script.section_of(asked.index) if script and asked else None
        where = f"{said.lesson}#{section.slug}" if section else ""
        return {"section": where, "question": asked.words if asked else ""}

    # -- mistakes --------------------------------------------------------------------------------------

    def _mistakes(self, made: Sequence[Mistake]) -> Iterable[MistakeState]:
        known = {one.id: one for one in (*self._catalog.exercises(), *self._catalog.warm_ups())}
        for one in made:
            exercise = known.get(one.exercise)
            if exercise is None:
                continue
            yield filled(
                MistakeState,
                one,
                title=exercise.task_called(one.task).title,
                looks_like=_looks_like(exercise, one),
                read=exercise.where_to_read(one.task),
                first_seen=one.first.isoformat(),
                last_seen=one.last.isoformat(),
                mended_at=one.mended.isoformat() if one.mended else None,
                given=one.diagnosis in {task.fault for task in exercise.task if task.id == one.task},
            )

    # -- what to read again ----------------------------------------------------------------------------

    def _revisit(self) -> Iterable[Revisit]:
        why: dict[str, list[str]] = {}
        for one in self.mistakes:
            if one.mended_at is None:
                why.setdefault(one.read, []).append(f"{one.task} in {one.exercise}: {one.diagnosis}")
        said = self.predictions.each if self.predictions is not None else ()
        wrong = Counter(each.section for each in said if each.judged == "wrong" and each.section)
        for place, count in wrong.items():
            often = "a prediction was" if count == 1 else f"{count} predictions were"
            why.setdefault(place, []).append(f"{often} wrong")
        for place, reasons in sorted(why.items(), key=lambda item: -len(item[1])):
            lesson, title, command = place.partition("#")[0], self._title(place), f"course lesson {place}"
            yield Revisit(lesson=lesson, section=place, title=title, why=tuple(reasons), command=command)

    def _title(self, place: str) -> str:
        """The section's title; the lesson's where there is no such section."""
        lesson, _, slug = place.partition("#")
        script = self._scripts(lesson)
        if script is None:
            return place
        return next((one.title for one in script.sections if one.slug == slug), script.lesson.title)


def show_learning(console: Console, learning: Learning) -> None:
    """Print what there is; nothing for a student who predicted nothing and made no mistake."""
    if learning.predictions is not None:
        _show_predictions(console, learning.predictions)
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
        if one.mended_at is None and one.read == section and one.task not in tasks.get(one.exercise, ()):
            tasks.setdefault(one.exercise, []).append(one.task)
    reasons = [f"{exercise}: {', '.join(names)}" for exercise, names in tasks.items()]
    said = learning.predictions.each if learning.predictions is not None else ()
    wrong = sum(one.judged == "wrong" and one.section == section for one in said)
    if wrong:
        reasons.append("a wrong prediction" if wrong == 1 else f"{wrong} wrong predictions")
    return "; ".join(reasons)


def _show_predictions(console: Console, predictions: PredictionsState) -> None:
    whole = predictions.all
    console.heading("Predictions", f"{whole.said} made, {whole.skipped} skipped")
    days = predictions.by_day[-_DAYS:]
    for one in (*predictions.by_lesson, *(days if len(days) > 1 else ())):
        console.line(f"{one.of}: {_in_words(one)}", indent=2)


#: So many mistakes that are open and so many that are mended are shown, the newest of each.
_OPEN, _MENDED = 5, 3


def _show_mistakes(console: Console, what: str, done: str, mistakes: Sequence[MistakeState]) -> None:
    """How many, and each with the day it was made or fixed."""
    if not mistakes:
        return
    fixed = sum(one.mended_at is not None for one in mistakes)
    console.heading(what, f"{len(mistakes)} {done}, {fixed} fixed")
    shown = [one for one in mistakes if not one.mended_at][-_OPEN:]
    shown += [one for one in mistakes if one.mended_at][-_MENDED:]
    for one in (one for one in mistakes if one in shown):
        seen = f"in {one.runs} checks since" if one.runs > 1 else "seen"
        state = f"not fixed yet, {seen} {day(one.first_seen)}"
        state = f"fixed {day(one.mended_at)}" if one.mended_at else state
        # A diagnosis of a check's own code has no words here; its name is made of words.
        words = one.looks_like or f"{one.diagnosis.replace('_', ' ').capitalize()}."
        console.line(f"{one.title} ({one.exercise}), {state}: {words}", indent=2)
    if len(shown) < len(mistakes):
        console.line(f"And {len(mistakes) - len(shown)} more, in `course progress --json`.", indent=2)


def _in_words(counts: PredictionsOf) -> str:
    """ "3 right, 1 nearly, 1 wrong, 1 skipped"; zero counts are left out."""
    named = (
        (counts.right, "right"),
        (counts.nearly, "nearly right"),
        (counts.wrong, "wrong"),
        (counts.unjudged, "not compared"),
        (counts.skipped, "skipped"),
    )
    return ", ".join(f"{number} {word}" for number, word in named if number)


def _looks_like(exercise: Exercise, mistake: Mistake) -> str:
    """The diagnosis in words; "" where the exercise keeps none as data."""
    from course.scoring.explain.story import read_table

    table = read_table(Path(exercise.folder))
    entry = table.words.get(mistake.diagnosis) if table else None
    # Records of earlier versions do not say which exception it was.
    raised = f"Raised {mistake.raised.rstrip(' .') or 'an exception'}."
    return (entry.looks_like if entry else "") or (raised if mistake.diagnosis == "RAISED" else "")


def _day(said: RecordedPrediction) -> str:
    return said.at.astimezone().strftime("%Y-%m-%d")


def day(moment: str) -> str:
    """The local date and time of an ISO moment, to the minute."""
    return datetime.fromisoformat(moment).astimezone().strftime("%Y-%m-%d %H:%M")


# ---
# The learning objectives, with the evidence that each was reached.


def objective_states(
    catalog: Catalog, standing: Standing, states: Sequence[ExerciseState], warm_ups: Sequence[WarmUpState]
) -> tuple[ObjectiveState, ...]:
    """The evidence for each objective; raises what reading the record raises."""
    predicted = {
        (event.subject, event.data.get("key"))
        for event in standing.events("prediction")
        if event.data.get("text")
    }
    passed = {state.id for state in states if state.passed_at is not None}
    rights = [attempt.right.items() for attempt in standing.quiz.counting]
    answered = {question for items in rights for question, right in items if right}
    return tuple(
        filled(
            ObjectiveState,
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
