"""A field for a prediction in a cell; once it is kept, the answer stands below it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from course.notebooks.widgets.form import Form

__all__ = ["Predict"]


class Predict(Form):
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

    def _hear(self, message: Any) -> None:
        match message:
            case {"kind": "hello"} if self.asked.said is not None:
                self.send({"kind": "kept"})
            case {"kind": "predict", "text": str(text)}:
                self.asked.say(text)
                self.send({"kind": "kept"})
                self._open()

    def _below(self) -> dict[str, str]:
        text = self.asked.opened if self.asked.said is not None else ""
        return {"text/markdown": text, "text/plain": text}
