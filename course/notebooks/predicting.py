"""A prediction in a lesson's notebook: the student types it, it is recorded, and only then is it answered."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from course.catalog.load import Catalog
from course.catalog.models import Lesson
from course.errors import CourseError, NotFoundError
from course.notebooks.sandbox import alive
from course.progress.quiz import quiz_history
from course.progress.workspace import Recorder
from course.quizzing.bank import Result, fresh_seed
from course.reading.parts import Question, Script, read_script
from course.reading.record import InProgress


def predict(lesson_id: str, number: int, text: str = "") -> Any:
    """A field to type a prediction in; where a cell cannot show one, the text in the call counts.

    Args:
        number: 1 for the first prediction of the lesson.
        text: the prediction, if it was written into the cell.

    Raises:
        NotFoundError: there is no such lesson or prediction.
    """
    asked = LessonPrediction(lesson_id, number)
    if text.strip():
        asked.say(text)
    if asked.said is None and alive():
        from course.notebooks.widgets import Predict

        return Predict(asked)
    return asked


class LessonPrediction:
    """A lesson's prediction, and the student's answer."""

    def __init__(self, lesson_id: str, number: int) -> None:
        catalog = Catalog()
        lesson = catalog.lesson(lesson_id)
        script = read_script(lesson)
        found = [one for one in script.questions if one.number == number]
        if not found:
            raise NotFoundError(
                f"{lesson_id} has no prediction {number}.",
                help=f"It has {len(script.questions)}.",
                code="no_such_prediction",
            )
        self.question: Question = found[0]
        self._unread = ""
        self._answer = answer_of(catalog, lesson, script, self.question)
        self._record = Recorder.of_kernel(catalog.course_id) or Recorder(None)
        events = self._events(lesson)
        self._progress: InProgress = InProgress(script, events, self._record, catalog.version)

    @property
    def said(self) -> str | None:
        """The first answer; empty if it was skipped, None if there is none."""
        said = self._progress.prediction(self.question)
        return None if said is None else said.text

    def say(self, text: str) -> None:
        """Keep a prediction; an empty one is a skip. The first answer stays."""
        self._progress.predict(self.question, text)

    @property
    def note(self) -> str:
        """Another sentence to show: why something was not recorded, or could not be read."""
        return (self._record.trouble if self._record.store is not None else "") or self._unread

    @property
    def opened(self) -> str:
        """The prediction and the answer, as Markdown."""
        said = self.said
        told = f"You predicted: {_quoted(said)}" if said else "You skipped this prediction."
        return "\n\n".join(part for part in (told, self._answer, self.note) if part)

    def __repr__(self) -> str:
        return "Write your prediction between the quotation marks, and run this cell: the answer opens then."

    def _repr_markdown_(self) -> str:
        return repr(self) if self.said is None else self.opened

    def _events(self, lesson: Lesson) -> tuple[Any, ...]:
        if self._record.store is None:
            return ()
        try:
            return self._record.store.events("prediction", lesson.id)
        except CourseError as error:
            self._unread = f"{error.message} {error.help}"
            return ()


def answer_of(catalog: Catalog, lesson: Lesson, script: Script, question: Question) -> str:
    """The passage that answers a prediction, as Markdown; empty if the lesson has none."""
    from course.notebooks.build import FOLDERS
    from course.notebooks.lowering import Lowering

    if question.answer is None:
        return ""
    return Lowering(FOLDERS.links(catalog, lesson.id)).block(script.blocks[question.answer])


def _quoted(text: str) -> str:
    from course.notebooks.lowering import escaped

    return escaped(" ".join(text.split()))


# ---
# The quiz in a cell: an attempt that counts like one of ``course quiz take``.


def take() -> Any:
    """An attempt at the quiz; None, with a sentence, where a cell cannot show one.

    Raises:
        NotFoundError: the course has no quiz.
    """
    if not alive():
        print("Without anywidget there is no attempt here: practise below, or run `course quiz take`.")  # noqa: T201 - a cell's output is its screen
        return None
    from course.notebooks.widgets import QuizForm

    return QuizForm(OngoingAttempt())


class OngoingAttempt:
    """The unfinished attempt, or a new one.

    Attributes:
        result: its score, once it has one.
    """

    def __init__(self) -> None:
        from course.quizzing.bank import Bank
        from course.quizzing.desk import begun, fits

        catalog = Catalog()
        bank = Bank.of(catalog)
        self.result: Result | None = None
        outside = Recorder(None, "This was not recorded: the notebook is not in a workspace.")
        self._record = Recorder.of_kernel(catalog.course_id) or outside
        history = quiz_history(self._record.store.events() if self._record.store is not None else ())
        left = history.open
        if left is None or not fits(bank, left):
            left = begun(bank, fresh_seed(bank, history.last_seeds()), catalog.version, self._record)
        self.attempt = left
        self.posed = bank.pose(left.seed)

    @property
    def note(self) -> str:
        """Another sentence to show: why something was not recorded."""
        return self._record.trouble

    def finish(self, letters: Mapping[str, str]) -> bool:
        """Score the attempt with letters by question id; False while one is not answered.

        Earlier answers stay.
        """
        from course.quizzing.desk import answered, finished

        chosen = {one.question: one.choice(str(letters.get(one.question, ""))) for one in self.posed}
        waiting = [one for one in self.posed if one.question not in self.attempt.answers]
        if self.result is not None or any(chosen[one.question] is None for one in waiting):
            return self.result is not None
        for one in waiting:
            choice = chosen[one.question]
            if choice is not None:
                answered(self.attempt, one.question, choice.id, self._record)
        self.result = finished(self.attempt, self.posed, self._record)
        return True
