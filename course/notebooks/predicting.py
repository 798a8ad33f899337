"""A prediction in a lesson's notebook: the student types it, it is recorded, and only then is it answered."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from course.catalog.load import Catalog
from course.catalog.models import Lesson
from course.errors import CourseError, NotFoundError
from course.notebooks.sandbox import alive
from course.progress.quiz import QuizHistory
from course.progress.store import Store
from course.quizzing.attempt import Result
from course.reading.parts import Question, Script
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
    """A lesson's prediction, and the student's answer.

    Attributes:
        note: another sentence to show.
    """

    def __init__(self, lesson_id: str, number: int) -> None:
        from course.catalog.load import Catalog
        from course.reading.parts import read_script
        from course.reading.record import InProgress

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
        self.note = ""
        self._answer = answer_of(catalog, lesson, script, self.question)
        self._store = _store(catalog)
        events = self._events(lesson)
        self._progress: InProgress = InProgress(script, events, self._write, catalog.version)

    @property
    def said(self) -> str | None:
        """The first answer; empty if it was skipped, None if there is none."""
        said = self._progress.prediction(self.question)
        return None if said is None else said.text

    def say(self, text: str) -> None:
        """Keep a prediction; an empty one is a skip. The first answer stays."""
        self._progress.predict(self.question, text)

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
        if self._store is None:
            return ()
        try:
            return self._store.events("prediction", lesson.id)
        except CourseError as error:
            self.note = f"{error.message} {error.help}"
            return ()

    def _write(self, kind: str, subject: str, data: Mapping[str, Any]) -> None:
        if self._store is None:
            return
        try:
            self._store.append(kind, subject, data)
        except CourseError as error:
            self.note = f"This was not recorded: {error.message} {error.help}"


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


def _store(catalog: Catalog) -> Store | None:
    """The workspace this kernel runs in; None outside of one, or in another course's."""
    from course.progress.workspace import Workspace

    try:
        workspace = Workspace.find(Path.cwd())
    except (NotFoundError, FileNotFoundError):  # also where the folder is gone
        return None
    return workspace.store if workspace.course_id == catalog.course_id else None


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
        note: another sentence to show.
    """

    def __init__(self) -> None:
        from course.catalog.load import Catalog
        from course.quizzing.attempt import fresh_seed
        from course.quizzing.bank import Bank
        from course.quizzing.desk import begun, fits

        catalog = Catalog()
        bank = Bank.of(catalog)
        self.note = ""
        self.result: Result | None = None
        self._store = self._found(catalog)
        history = self._history()
        left = history.open
        if left is None or not fits(bank, left):
            left = begun(bank, fresh_seed(bank, history.last_seeds()), catalog.version, self._record)
        self.attempt = left
        self.posed = bank.pose(left.seed)

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

    def _found(self, catalog: Catalog) -> Store | None:
        from course.progress.workspace import Workspace

        try:
            workspace = Workspace.find(Path.cwd())
        except (NotFoundError, FileNotFoundError):  # also where the folder is gone
            self.note = "This was not recorded: the notebook is not in a workspace."
            return None
        if workspace.course_id != catalog.course_id:
            self.note = f"This was not recorded: {workspace.root} is a workspace of another course."
            return None
        return workspace.store

    def _history(self) -> QuizHistory:
        from course.progress.quiz import quiz_history

        return quiz_history(self._store.events() if self._store is not None else ())

    def _record(self, kind: str, subject: str, data: dict[str, object]) -> None:
        if self._store is None:
            return
        try:
            self._store.append(kind, subject, data)
        except CourseError as error:
            self.note = f"This was not recorded: {error.message} {error.help}"
