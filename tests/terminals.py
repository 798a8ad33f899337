"""A terminal of its own, in tmux: keys and a mouse as a terminal sends them, and what is on the screen."""

import os
import shutil
import subprocess
import time
from collections.abc import Callable
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]

#: Where a program that has ended leaves the terminal: the usual screen, no mouse reports, a cursor.
AS_IT_WAS = "0 0 1"

needs_tmux = pytest.mark.skipif(shutil.which("tmux") is None, reason="tmux is not installed")


class Terminal:
    """A pane of its own server, so that nobody else's is touched."""

    def __init__(self, folder: Path, size: tuple[int, int]) -> None:
        self._socket = str(folder / "tmux")
        environment = {
            "PATH": os.environ["PATH"],
            "HOME": str(folder),
            "LANG": "C.UTF-8",
            "LC_ALL": "C.UTF-8",
            "PYTHONPATH": str(ROOT),
        }
        shell = ("env", "PS1=$ ", "COLORTERM=truecolor", "sh")
        started = ("tmux", "-S", self._socket, "-f", os.devnull, "new-session", "-d")
        place = ("-x", str(size[0]), "-y", str(size[1]), "-c", str(folder))
        subprocess.run([*started, *place, *shell], env=environment, check=True, timeout=20)

    def _tmux(self, *arguments: str) -> str:
        done = subprocess.run(
            ["tmux", "-S", self._socket, *arguments], capture_output=True, text=True, check=False, timeout=20
        )
        return done.stdout

    def type(self, words: str) -> None:
        """Letters as they are, whatever keys are named like them."""
        self._tmux("send-keys", "-l", words)

    def line(self, words: str) -> None:
        """A line to the shell."""
        self.type(words)
        self.keys("Enter")

    def keys(self, *names: str) -> None:
        self._tmux("send-keys", *names)

    def mouse(self, kind: int, column: int, row: int, end: str = "M") -> None:
        """A mouse's report as terminals send it; columns and rows from 1."""
        self._tmux("send-keys", "-l", f"\x1b[<{kind};{column};{row}{end}")

    def resize(self, columns: int, rows: int) -> None:
        self._tmux("resize-window", "-x", str(columns), "-y", str(rows))

    def coloured(self) -> str:
        """The screen with what says how it is coloured."""
        return self._tmux("capture-pane", "-p", "-e")

    def screen(self) -> str:
        return self._tmux("capture-pane", "-p")

    def until(self, true: Callable[[str], bool], seconds: float = 40.0) -> str:
        """The screen, once something is true of it."""
        end = time.monotonic() + seconds
        while not true(screen := self.screen()):
            assert time.monotonic() < end, screen
            time.sleep(0.1)
        return screen

    def wait(self, *words: str, seconds: float = 40.0) -> str:
        """The screen, once it shows one of these."""
        return self.until(lambda screen: any(word in screen for word in words), seconds)

    def wait_until_gone(self, word: str) -> None:
        """Until the screen no longer shows this."""
        self.until(lambda screen: word not in screen)

    def wait_for_other(self, screen: str) -> str:
        """The screen, once it is another one and still."""
        until = time.monotonic() + 40.0
        while (shown := self.still()) == screen:
            assert time.monotonic() < until, shown
        return shown

    def still(self) -> str:
        """The screen, once it has stood still for a moment."""
        shown, before = self.screen(), ""
        while shown != before:
            time.sleep(0.2)
            shown, before = self.screen(), shown
        return shown

    def state(self) -> str:
        """What a program may leave behind: the other screen, mouse reports, a hidden cursor."""
        return self._tmux("display", "-p", "#{alternate_on} #{mouse_any_flag} #{cursor_flag}").strip()

    def close(self) -> None:
        self._tmux("kill-server")
