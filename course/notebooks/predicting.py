"""A prediction in a lesson's notebook: the student types it, it is recorded, and only then is it answered."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from course.errors import CourseError, NotFoundError
from course.notebooks.sandbox import alive

if TYPE_CHECKING:
    from collections.abc import Mapping

    from course.catalog.load import Catalog
    from course.catalog.models import Lesson
    from course.progress.store import Store
    from course.reading.parts import Question, Script
    from course.reading.record import InProgress

__all__ = ["LessonPrediction", "answer_of", "predict"]


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
        from course.notebooks.widgets.predict import Predict

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
    from course.notebooks.building.layout import FOLDERS
    from course.notebooks.building.lowering import Lowering

    if question.answer is None:
        return ""
    return Lowering(FOLDERS.links(catalog, lesson.id)).block(script.blocks[question.answer])


def _quoted(text: str) -> str:
    from course.notebooks.building.lowering import escaped

    return escaped(" ".join(text.split()))


def _store(catalog: Catalog) -> Store | None:
    """The workspace this kernel runs in; None outside of one, or in another course's."""
    from course.progress.workspace import Workspace

    try:
        workspace = Workspace.find(Path.cwd())
    except (NotFoundError, FileNotFoundError):  # also where the folder is gone
        return None
    return workspace.store if workspace.course_id == catalog.course_id else None
