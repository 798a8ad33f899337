"""A field for a prediction in a cell; once the prediction is kept, the answer appears below it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from course.notebooks.widgets.form import Form

__all__ = ["Predict"]


class Predict(Form):
    """A field that waits for a prediction.

    Args:
        asked: see ``predicting.Asked``; that module imports this one.

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
