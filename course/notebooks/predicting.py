"""A prediction in a lesson's notebook: the student types it, it is recorded, and only then is it answered."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from course.catalog.load import Catalog
from course.catalog.models import Lesson
from course.errors import CourseError, NotFoundError
from course.notebooks.sandbox import alive
from course.progress.history import lesson_events
from course.progress.quiz import quiz_history
from course.progress.workspace import Recorder
from course.quizzing.bank import Bank, Result, fresh_seed
from course.reading.parts import Question, Script, read_script
from course.reading.record import JUDGEMENTS, InProgress


def predict(lesson_id: str, number: int, text: str = "", judged: str = "") -> Any:
    """A field to type a prediction in; where a cell cannot show one, the text in the call counts.

    Args:
        number: 1 for the first prediction of the lesson.
        text: the prediction, if it was written into the cell.
        judged: how it did, by the student's own word: "right", "nearly" or "wrong".

    Raises:
        NotFoundError: there is no such lesson or prediction.
    """
    asked = LessonPrediction(lesson_id, number)
    if text.strip():
        asked.say(text)
    asked.judge(judged)
    if not text.strip() and asked.waits and alive():
        from course.notebooks.widgets import Predict

        return Predict(asked)
    return asked


def finish(lesson_id: str) -> LessonEnd:
    """The end of a lesson: it counts as read once each of its predictions was answered or skipped.

    Raises:
        NotFoundError: there is no such lesson.
    """
    return LessonEnd(lesson_id)


class _Opened:
    """A lesson in a kernel, with the record of the workspace that the kernel runs in."""

    def __init__(self, lesson_id: str) -> None:
        self._catalog = Catalog()
        self._lesson = self._catalog.lesson(lesson_id)
        self._script = read_script(self._lesson)
        self._unread = ""
        self._record = Recorder.of_kernel(self._catalog.course_id) or Recorder(None)
        self._progress = InProgress(self._script, self._events(), self._record, self._catalog.version)

    @property
    def note(self) -> str:
        """Another sentence to show: why something was not recorded, or could not be read."""
        return (self._record.trouble if self._record.store is not None else "") or self._unread

    def _events(self) -> tuple[Any, ...]:
        try:
            return lesson_events(self._record.store, self._lesson.id, self._catalog.syllabus.split)
        except CourseError as error:
            self._unread = f"{error.message} {error.help}"
            return ()


class LessonEnd(_Opened):
    """What stands below the last cell of a lesson."""

    def __init__(self, lesson_id: str) -> None:
        super().__init__(lesson_id)
        self._open = sum(self._progress.prediction(one) is None for one in self._script.questions)
        if not self._open:
            self._progress.reached_end()

    def __repr__(self) -> str:
        if self._open:
            what = "One prediction of this lesson is" if self._open == 1 else f"{self._open} predictions are"
            return (
                f"{what} open: answer or skip {'it' if self._open == 1 else 'them'}, and run this cell again."
            )
        if self._record.store is None:
            return "You have read it. It is recorded in a workspace only: course init my-course makes one."
        return self.note or "You have read it, and it is recorded. What is next: course next"


class LessonPrediction(_Opened):
    """A lesson's prediction, and the student's answer."""

    def __init__(self, lesson_id: str, number: int) -> None:
        super().__init__(lesson_id)
        found = [one for one in self._script.questions if one.number == number]
        if not found:
            problem = f"{lesson_id} has no prediction {number}."
            help_ = f"It has {len(self._script.questions)}."
            raise NotFoundError(problem, help=help_, code="no_such_prediction")
        self.question: Question = found[0]
        self._answer = answer_of(self._catalog, self._lesson, self._script, self.question)

    @property
    def said(self) -> str | None:
        """The first answer; empty if it was skipped, None if there is none."""
        said = self._progress.prediction(self.question)
        return None if said is None else said.text

    def say(self, text: str) -> None:
        """Keep a prediction; an empty one is a skip. The first answer stays."""
        self._progress.predict(self.question, text)

    def judge(self, word: str) -> None:
        """Keep how the prediction did: "right", "nearly" or "wrong"; another word is none."""
        for known in JUDGEMENTS:
            if word == known:
                self._progress.judge(self.question, known)

    @property
    def judged(self) -> str:
        """How it did; empty if it is not said yet."""
        said = self._progress.prediction(self.question)
        return (said.judged or "") if said is not None else ""

    @property
    def waits(self) -> bool:
        """Whether something is still to be said: the prediction, or how it did."""
        return self.said is None or bool(self.said and not self.judged)

    @property
    def opened(self) -> str:
        """The prediction and the answer, as Markdown."""
        said = self.said
        told = f"You predicted: {_quoted(said)}" if said else "You skipped this prediction."
        told += f" By your own word: {self.judged}." if self.judged else ""
        return "\n\n".join(part for part in (told, self._answer, self.note) if part)

    def __repr__(self) -> str:
        return "Write your prediction between the quotation marks, and run this cell: the answer opens then."

    def _repr_markdown_(self) -> str:
        if self.said is None:
            return repr(self)
        name = f"my_prediction_{self.question.number}"
        more = f'predict("{self._lesson.id}", {self.question.number}, {name}, "nearly")'
        return (
            f"{self.opened}\n\nHow did it do? `{more}` says it; or right, or wrong."
            if self.waits
            else self.opened
        )


def answer_of(catalog: Catalog, lesson: Lesson, script: Script, question: Question) -> str:
    """The passage that answers a prediction, as Markdown; empty if the lesson has none."""
    from course.notebooks.build import FOLDERS
    from course.notebooks.cells import Lowering

    if question.answer is None:
        return ""
    return Lowering(FOLDERS.links(catalog, lesson.id)).block(script.blocks[question.answer])


def _quoted(text: str) -> str:
    from course.notebooks.cells import escaped

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
        from course.quizzing.bank import mark
        from course.quizzing.desk import answered, caught_up, finished

        events = self._record.store.events() if self.result is None and self._record.store is not None else ()
        if caught_up(self.attempt, quiz_history(events)):
            self._record.trouble = "This attempt was finished elsewhere: the answers given there count."
            self.result = mark(self.posed, self.attempt.answers)
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
