"""Figures as half blocks of a terminal, drawn by a separate process.

Drawing needs matplotlib, which is slow to load and large; the reader stays quick and small without it.
"""

from __future__ import annotations

import base64
import contextlib
import hashlib
import json
import subprocess
import sys
import tempfile
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

from rich.text import Text

from course.browser import opened
from course.cli.frame.pictures import half_blocks

#: A figure's height, in cells, as a share of its width; its caption stands below it on the same screen.
_LOW = 0.26
_CAPTION = 5
_LEAST = 8
#: Lines of a finding with its hint.
_FINDING = 11


class Drawer:
    """Draws figures, one after the other; each is drawn once for a size."""

    def __init__(self) -> None:
        self._drawn: dict[tuple[str, int, int], list[Text]] = {}
        self._asked: set[tuple[str, int, int]] = set()
        self._waiting: dict[int, Callable[[dict[str, Any]], None]] = {}
        self._process: subprocess.Popen[str] | None = None
        self._folder: tempfile.TemporaryDirectory[str] | None = None
        self._number = 0

    def rows(self, figure: str, columns: int, room: int, drawn: Callable[[str], None]) -> list[Text]:
        """A figure's lines; blank ones while it is being drawn, so that nothing moves when it arrives.

        Args:
            columns: how wide.
            room: lines of a screen; the figure and the start of its caption fit.
            drawn: called with the figure's id once it is there, from another thread.
        """
        rows = max(_LEAST, min(round(columns * _LOW), room - _CAPTION))
        return self._rows((figure, columns, rows), {"figure": figure}, lambda: drawn(figure))

    def curve_rows(
        self, task: str, reply: dict[str, Any], columns: int, room: int, drawn: Callable[[str], None]
    ) -> list[Text]:
        """The lines of a failed check's curve over the right one, so few that its finding fits below them.

        Args:
            task: whose check it is; ``drawn`` is called with it.
            reply: a curve of ``course check --json``.
        """
        rows = max(_LEAST, min(round(columns * _LOW), room - _FINDING))
        name = hashlib.sha256(json.dumps(reply).encode()).hexdigest()
        return self._rows((name, columns, rows), {"curve": reply}, lambda: drawn(task))

    def _rows(
        self, key: tuple[str, int, int], request: dict[str, Any], drawn: Callable[[], None]
    ) -> list[Text]:
        _, columns, rows = key
        if key not in self._drawn and key not in self._asked:
            self._asked.add(key)

            def take(answer: dict[str, Any]) -> None:
                if "pixels" in answer:
                    self._drawn[key] = half_blocks(
                        base64.b64decode(answer["pixels"]), columns, rows, answer["labels"]
                    )
                else:
                    self._drawn[key] = []  # it stays described
                drawn()

            self._ask({**request, "columns": columns, "rows": rows}, take)
        return self._drawn.get(key, [Text()] * rows)

    def open(self, figure: str, say: Callable[[str], None]) -> None:
        """Show a figure as on paper in the system's viewer, or say where its file is."""

        def take(answer: dict[str, Any]) -> None:
            if "png" not in answer:
                say(answer.get("error", "The figure could not be drawn."))
                return
            if self._folder is None:
                self._folder = tempfile.TemporaryDirectory(prefix="course-figures-")
            path = Path(self._folder.name) / f"{figure}.png"
            path.write_bytes(base64.b64decode(answer["png"]))
            if opened(path.as_uri()):
                say(f"Opened {figure}.png")
            else:
                say(f"No viewer here; until you leave, the figure is {path}")

        self._ask({"figure": figure, "png": True}, take)

    def close(self) -> None:
        """End the drawing process."""
        if self._process is not None:
            self._process.kill()
            self._process.wait()
            for stream in (self._process.stdin, self._process.stdout):
                if stream is not None:
                    with contextlib.suppress(OSError):
                        stream.close()
            self._process = None
        if self._folder is not None:
            self._folder.cleanup()
            self._folder = None

    def _ask(self, request: dict[str, Any], take: Callable[[dict[str, Any]], None]) -> None:
        if self._process is None:
            self._process = subprocess.Popen(
                [sys.executable, "-m", "course.figures.terminal"],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.DEVNULL,
                text=True,
                encoding="utf-8",
            )
            threading.Thread(target=self._listen, args=(self._process,), name="figures", daemon=True).start()
        self._number += 1
        self._waiting[self._number] = take
        assert self._process.stdin is not None
        with contextlib.suppress(OSError, ValueError):  # it ended: figures stay described
            self._process.stdin.write(json.dumps({**request, "id": self._number}) + "\n")
            self._process.stdin.flush()

    def _listen(self, process: subprocess.Popen[str]) -> None:
        assert process.stdout is not None
        with contextlib.suppress(OSError, ValueError):  # closed on the way out
            for line in process.stdout:
                answer = json.loads(line)
                self._waiting.pop(answer["id"])(answer)
