"""A field for a prediction in a cell; once it is kept, the answer stands below it."""

from __future__ import annotations

import asyncio
from pathlib import Path
from typing import TYPE_CHECKING, Any
from uuid import uuid4

import anywidget

if TYPE_CHECKING:
    from collections.abc import Callable

__all__ = ["Predict"]


class Predict(anywidget.AnyWidget):  # type: ignore[misc]
    """A prediction that waits to be typed.

    Args:
        asked: see ``predicting.Asked``, which stands above this file and is not imported here.

    Raises:
        RuntimeError: no event loop runs here, as one does in every kernel.
    """

    _esm = Path(__file__).with_suffix(".js").read_text("utf-8")

    def __init__(self, asked: Any) -> None:
        super().__init__()
        self.asked = asked
        self._loop = asyncio.get_running_loop()  # see ``widget.Sandbox``: messages come on another thread
        self._shown = uuid4().hex
        self.on_msg(lambda _, message, __: self._loop.call_soon_threadsafe(self._hear, message))

    def _hear(self, message: Any) -> None:
        match message:
            case {"kind": "hello"} if self.asked.said is not None:
                self.send({"kind": "kept"})
            case {"kind": "predict", "text": str(text)}:
                self.asked.say(text)
                self.send({"kind": "kept"})
                self._open(update=True)

    def _ipython_display_(self) -> None:
        """The field, and below it the place where the answer opens."""
        import IPython.display

        show: Callable[..., Any] = IPython.display.display  # typed or not, whether it is installed or not
        show(super()._repr_mimebundle_()[0], raw=True)
        self._open(update=False)

    def _open(self, *, update: bool) -> None:
        import IPython.display

        show: Callable[..., Any] = IPython.display.display
        text = self.asked.opened if self.asked.said is not None else ""
        show({"text/markdown": text, "text/plain": text}, raw=True, display_id=self._shown, update=update)
