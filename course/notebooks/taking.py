"""The quiz in a cell: an attempt that counts like one of ``course quiz take``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from course.errors import CourseError, NotFoundError
from course.notebooks.sandbox import alive

if TYPE_CHECKING:
    from collections.abc import Mapping

    from course.catalog.load import Catalog
    from course.progress.quiz import QuizHistory
    from course.progress.store import Store
    from course.quizzing.attempt import Result

__all__ = ["OngoingAttempt", "take"]


def take() -> Any:
    """An attempt at the quiz; None, with a sentence, where a cell cannot show one.

    Raises:
        NotFoundError: the course has no quiz.
    """
    if not alive():
        print("Without anywidget there is no attempt here: practise below, or run `course quiz take`.")  # noqa: T201 - a cell's output is its screen
        return None
    from course.notebooks.widgets.take import QuizForm

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
