"""The reader in a real terminal: one lesson as a student reads it, and the line it comes back to."""

from __future__ import annotations

import contextlib
import fcntl
import os
import pty
import select
import signal
import struct
import subprocess
import sys
import termios
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from course.progress.store import Store
from tests.command_line import in_process

ROOT = Path(__file__).resolve().parents[4]
LESSON = "numerical-integration"
#: However slow the machine is: what is waited for comes within this, in s, or never.
NEVER = 90.0
#: Once nothing has come for so long, a screen is complete, in s: it is drawn in a few hundredths.
SETTLED = 0.5


class Terminal:
    """A program on a terminal of its own."""

    def __init__(self, folder: Path, *arguments: str, **environment: str) -> None:
        self._ours, theirs = pty.openpty()
        self.resize(80, 24)
        self.said = b""
        known = {name: os.environ[name] for name in ("PATH", "HOME") if name in os.environ}
        self.process = subprocess.Popen(
            [sys.executable, "-m", "course", *arguments],
            cwd=folder,
            stdin=theirs,
            stdout=theirs,
            stderr=theirs,
            start_new_session=True,
            preexec_fn=lambda: fcntl.ioctl(0, termios.TIOCSCTTY, 0),  # noqa: PLW1509 - no threads yet
            env={
                **known,
                "TERM": "xterm-256color",
                "LANG": "C.UTF-8",
                "PYTHONPATH": str(ROOT),
                **environment,
            },
        )
        os.close(theirs)

    def resize(self, columns: int, rows: int) -> None:
        fcntl.ioctl(self._ours, termios.TIOCSWINSZ, struct.pack("HHHH", rows, columns, 0, 0))

    def keys(self, text: str) -> None:
        os.write(self._ours, text.encode())

    def wait(self, *words: str) -> str:
        """What was written since the last wait, once one of these is in it."""
        until, new = time.monotonic() + NEVER, b""
        while time.monotonic() < until:
            if any(word.encode() in new for word in words):
                return new.decode("utf-8", "replace")
            if not select.select([self._ours], [], [], 0.2)[0]:
                continue
            try:
                data = os.read(self._ours, 1 << 16)
            except OSError:
                break
            self.said += data
            new += data
        pytest.fail(f"{words} did not come; what came ended with {self.said[-600:]!r}")

    def screen(self, *words: str) -> str:
        """As ``wait``, and what follows until nothing more does: a screen comes in pieces."""
        new = self.wait(*words)
        while select.select([self._ours], [], [], SETTLED)[0]:
            data = os.read(self._ours, 1 << 16)
            self.said += data
            new += data.decode("utf-8", "replace")
        return new

    def end(self) -> int:
        """Until the program has ended; its exit code."""
        until = time.monotonic() + NEVER
        while self.process.poll() is None and time.monotonic() < until:
            with contextlib.suppress(OSError):
                if select.select([self._ours], [], [], 0.2)[0]:
                    self.said += os.read(self._ours, 1 << 16)
        return self.process.wait(1)

    def close(self) -> None:
        if self.process.poll() is None:
            self.process.kill()
            self.process.wait()
        os.close(self._ours)


@pytest.fixture
def workspace(tmp_path: Path) -> Path:
    assert in_process("init", tmp_path / "mine").returncode == 0
    return tmp_path / "mine"


@pytest.fixture
def terminals() -> Iterator[list[Terminal]]:
    opened: list[Terminal] = []
    yield opened
    for terminal in opened:
        terminal.close()


def test_a_student_reads_predicts_runs_and_comes_back_to_the_line(workspace, terminals):
    store = Store(workspace / ".course" / "progress.sqlite")
    first = Terminal(workspace, "lesson", LESSON)
    terminals.append(first)
    first.wait("min left")
    first.keys("G")
    first.wait("You have read this lesson")
    first.keys("g")
    first.wait("min left")
    for _ in range(30):  # to the first prediction
        first.keys(" ")
        if "Enter predict" in first.screen("min left", "Enter predict", "the end"):
            break
    first.keys("\r")
    first.wait("keep it and open")
    first.keys("half a metre\r")
    first.wait("half a metre")
    until = time.monotonic() + NEVER
    while not store.events("prediction") and time.monotonic() < until:
        time.sleep(0.1)
    assert store.last("prediction", LESSON).data["text"] == "half a metre"
    first.keys("r")
    first.wait("prints the same")
    first.resize(60, 30)
    first.keys("j")
    first.wait("min left")
    os.killpg(first.process.pid, signal.SIGTERM)  # a closed window: the place is kept all the same
    assert first.end() == 0
    assert "\x1b[?1049l" in first.said.decode("utf-8", "replace")  # the other screen was left
    assert store.last("cell", LESSON).data["error"] == ""
    assert store.last("lesson", LESSON) is not None
    place = store.last("bookmark", LESSON).data
    assert place["block"] > 0
    again = Terminal(workspace, "lesson", LESSON)
    terminals.append(again)
    again.wait("min left")
    again.keys("\x03")
    assert again.end() == 0
    assert store.last("bookmark", LESSON).data["block"] == place["block"]


@pytest.mark.parametrize("shape", [{"TERM": "dumb"}, {"PYTHONIOENCODING": "ascii"}], ids=["dumb", "no-utf8"])
def test_a_terminal_that_cannot_be_drawn_on_gets_the_printed_lesson(workspace, terminals, shape):
    printed = Terminal(workspace, "lesson", LESSON, **shape)
    terminals.append(printed)
    assert printed.end() == 0
    assert "\x1b[?1049h" not in printed.said.decode("utf-8", "replace")
    assert b"Reading time: about" in printed.said
    assert Store(workspace / ".course" / "progress.sqlite").last("lesson", LESSON) is None
