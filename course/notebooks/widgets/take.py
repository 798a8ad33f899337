"""The questions of an attempt as a form in a cell; once it is sent, the result appears below it."""

from __future__ import annotations

from html import escape
from pathlib import Path
from typing import Any

from course.notebooks.quiz import Marks
from course.notebooks.widgets.form import Form

__all__ = ["QuizForm"]


class QuizForm(Form):
    """An attempt at the quiz.

    Args:
        taken: see ``taking.Taken``; that module imports this one.

    Raises:
        RuntimeError: no event loop runs here, as one does in every kernel.
    """

    _esm = Path(__file__).with_suffix(".js").read_text("utf-8")

    def __init__(self, taken: Any) -> None:
        super().__init__()
        self.taken = taken

    def _hear(self, message: Any) -> None:
        match message:
            case {"kind": "hello"}:
                self.send({"kind": "questions", "questions": self._questions()})
            case {"kind": "answers", "answers": dict(letters)} if self.taken.finish(letters):
                self._open()
        if self.taken.result is not None:
            self.send({"kind": "done"})

    def _questions(self) -> list[dict[str, Any]]:
        """The questions as they are asked: nothing in them says which option is right."""
        answers = self.taken.attempt.answers
        return [
            {
                "id": one.question,
                "title": one.title,
                "prompt": one.prompt,
                "options": [{"letter": each.letter, "text": each.text} for each in one.choices],
                "answered": next((c.letter for c in one.choices if c.id == answers.get(one.question)), ""),
            }
            for one in self.taken.posed
        ]

    def _below(self) -> dict[str, str]:
        result = self.taken.result
        if result is None:
            return {"text/html": "", "text/plain": ""}
        marks = Marks(result)
        return {
            "text/html": f"{marks._repr_html_()}<p>{escape(self.taken.note)}</p>",
            "text/plain": repr(marks),
        }
