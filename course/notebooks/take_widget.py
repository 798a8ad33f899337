"""The questions of an attempt as a form in a cell; once it is handed over, the marks stand below it."""

from __future__ import annotations

import asyncio
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any
from uuid import uuid4

import anywidget

from course.notebooks.quiz import Marks

if TYPE_CHECKING:
    from collections.abc import Callable

__all__ = ["Take"]


class Take(anywidget.AnyWidget):  # type: ignore[misc]
    """An attempt at the quiz.

    Args:
        taken: see ``taking.Taken``, which stands above this file and is not imported here.

    Raises:
        RuntimeError: no event loop runs here, as one does in every kernel.
    """

    _esm = Path(__file__).with_suffix(".js").read_text("utf-8")

    def __init__(self, taken: Any) -> None:
        super().__init__()
        self.taken = taken
        self._loop = asyncio.get_running_loop()  # see ``widget.Sandbox``: messages come on another thread
        self._shown = uuid4().hex
        self.on_msg(lambda _, message, __: self._loop.call_soon_threadsafe(self._hear, message))

    def _hear(self, message: Any) -> None:
        match message:
            case {"kind": "hello"}:
                self.send({"kind": "questions", "questions": self._questions()})
            case {"kind": "answers", "answers": dict(letters)} if self.taken.finish(letters):
                self._show(update=True)
        if self.taken.result is not None:
            self.send({"kind": "done"})

    def _questions(self) -> list[dict[str, Any]]:
        """As they are asked: nothing in them says which option is right."""
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

    def _ipython_display_(self) -> None:
        """The form, and below it the place for the marks."""
        import IPython.display

        show: Callable[..., Any] = IPython.display.display  # typed or not, whether it is installed or not
        show(super()._repr_mimebundle_()[0], raw=True)
        self._show(update=False)

    def _show(self, *, update: bool) -> None:
        import IPython.display

        show: Callable[..., Any] = IPython.display.display
        result = self.taken.result
        marks = "" if result is None else f"{Marks(result)._repr_html_()}<p>{escape(self.taken.note)}</p>"
        plain = "" if result is None else repr(Marks(result))
        show({"text/html": marks, "text/plain": plain}, raw=True, display_id=self._shown, update=update)
