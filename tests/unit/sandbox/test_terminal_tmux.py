"""The view in a real terminal: tmux, with keys and a mouse as a terminal sends them."""

from __future__ import annotations

import contextlib
import os
import shutil
import subprocess
import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from course.sandbox.scene.loading import choose, scene_ids
from course.sandbox.views.terminal.camera import Camera
from course.sandbox.world.world import World

if TYPE_CHECKING:
    from collections.abc import Iterator

pytestmark = [
    pytest.mark.soak,
    pytest.mark.skipif(shutil.which("tmux") is None, reason="tmux is not installed"),
]

ROOT = Path(__file__).resolve().parents[3]
PLAY = """
import sys
from course.sandbox.scene.loading import choose
from course.sandbox.views.terminal.view import play
from course.sandbox.world.world import World
chosen = choose(sys.argv[1])
world = World(chosen.scene, chosen.settings)
if "--fail" in sys.argv:
    def broken():
        raise RuntimeError("broken on purpose")
    world.drain_events = broken
print("pid", __import__("os").getpid(), flush=True)
play(world, chosen.scene, chosen=chosen)
print(f"left after {world.t:.2f} s")
"""


class Terminal:
    """A pane of its own server, so that nobody else's is touched."""

    def __init__(self, folder: Path, size: tuple[int, int]) -> None:
        self._socket = str(folder / "tmux")
        (folder / "play.py").write_text(PLAY, encoding="utf-8")
        environment = {
            "PATH": os.environ["PATH"],
            "HOME": str(folder),
            "LANG": "C.UTF-8",
            "LC_ALL": "C.UTF-8",
            "PYTHONPATH": str(ROOT),
        }
        shell = ("env", "PS1=$ ", "COLORTERM=truecolor", "sh")
        subprocess.run(
            [
                *("tmux", "-S", self._socket, "-f", os.devnull, "new-session", "-d"),
                *("-x", str(size[0]), "-y", str(size[1]), "-c", str(folder), *shell),
            ],
            env=environment,
            check=True,
            timeout=20,
        )

    def _tmux(self, *arguments: str) -> str:
        done = subprocess.run(
            ["tmux", "-S", self._socket, *arguments], capture_output=True, text=True, check=False, timeout=20
        )
        return done.stdout

    def start(self, *arguments: str) -> None:
        self.keys(f"{sys.executable} play.py {' '.join(arguments)}", "Enter")

    def keys(self, *names: str) -> None:
        self._tmux("send-keys", *names)

    def mouse(self, kind: int, column: int, row: int, end: str = "M") -> None:
        """A mouse's report as terminals send it; columns and rows from 1."""
        self._tmux("send-keys", "-l", f"\x1b[<{kind};{column};{row}{end}")

    def screen(self) -> str:
        return self._tmux("capture-pane", "-p")

    def wait(self, *words: str, seconds: float = 40.0) -> str:
        """The screen, once it shows one of these."""
        until = time.monotonic() + seconds
        while time.monotonic() < until:
            screen = self.screen()
            if any(word in screen for word in words):
                return screen
            time.sleep(0.1)
        pytest.fail(f"{words} did not appear on:\n{self.screen()}")

    def wait_until_gone(self, word: str, seconds: float = 40.0) -> None:
        """Until the screen no longer shows this."""
        until = time.monotonic() + seconds
        while word in (screen := self.screen()):
            assert time.monotonic() < until, screen
            time.sleep(0.1)

    def state(self) -> str:
        """What a program may leave behind: the other screen, mouse reports, a hidden cursor."""
        return self._tmux("display", "-p", "#{alternate_on} #{mouse_any_flag} #{cursor_flag}").strip()

    def close(self) -> None:
        self._tmux("kill-server")


@pytest.fixture
def size() -> tuple[int, int]:
    return 80, 24


@pytest.fixture
def terminal(tmp_path: Path, size: tuple[int, int]) -> Iterator[Terminal]:
    made = Terminal(tmp_path, size)
    with contextlib.closing(made):
        yield made


CLEAN = "0 0 1"


def test_a_scene_is_asked_about_run_compared_dragged_and_left(terminal: Terminal):
    terminal.start("head-on")
    terminal.wait("How fast does the right one go")
    assert terminal.state()[0] == "1"
    terminal.keys("2", "Enter")
    screen = terminal.wait("Your guess is right")
    assert "simulation" in screen
    terminal.keys("r")
    terminal.wait("From the start")
    terminal.keys("Space")
    terminal.wait("paused")
    # The left puck starts at x = -1 m; pull it upward from the cell in which its letter is.
    rows = terminal.screen().split("\n")
    row = next(i for i, line in enumerate(rows) if " l" in line[:48] and "m ─" not in line and i > 1)
    column = rows[row].index("l")
    terminal.mouse(0, column + 1, row + 1)
    terminal.mouse(32, column + 3, row + 1)
    terminal.mouse(32, column + 9, row - 2)
    terminal.wait("aiming")
    terminal.mouse(0, column + 9, row - 2, "m")
    terminal.wait("left-puck will fly at")
    terminal.keys("Space")
    terminal.wait("left puck is thrown", "left-puck is thrown")
    terminal.keys("q")
    terminal.wait("left after")
    assert terminal.state() == CLEAN


@pytest.mark.parametrize("how", ["C-c", "INT", "TERM", "HUP"])
def test_the_terminal_is_left_clean_however_one_leaves(terminal: Terminal, how: str):
    terminal.start("newtons-cradle")
    screen = terminal.wait("Before it runs")
    if how == "C-c":
        terminal.keys("C-c")
    else:
        found = subprocess.run(
            ["pgrep", "-f", f"{sys.executable} play.py newtons-cradle"],
            capture_output=True,
            text=True,
            check=True,
        )
        mine = [
            pid
            for pid in found.stdout.split()
            if Path(f"/proc/{pid}/cwd").resolve() == Path(terminal._socket).parent.resolve()
        ]
        assert len(mine) == 1, screen
        subprocess.run(["kill", f"-{how}", mine[0]], check=True)
    terminal.wait("left after")
    assert terminal.state() == CLEAN


def test_the_terminal_is_left_clean_after_an_error_which_is_reported_once(terminal: Terminal):
    terminal.start("head-on", "--fail")
    terminal.wait("RuntimeError: broken on purpose")
    time.sleep(0.5)
    assert terminal.screen().count("\nRuntimeError: broken on purpose") == 1
    assert terminal.state() == CLEAN


def highest(scene: str, size: tuple[int, int]) -> tuple[str, int, int, tuple[int, int]]:
    """The body without wheels that starts highest, its column and row, and a cell to pull it to."""
    chosen = choose(scene)
    world = World(chosen.scene, chosen.settings)
    # What stands around the picture: a line above; events and keys below; numbers beside it.
    columns, rows = {(80, 24): (50, 19), (160, 50): (114, 40)}[size]
    camera = Camera.fit(chosen.scene.view, columns, rows)
    shot = world.snapshot()
    y, x, name = max(
        (y, x, part.name)
        for part, x, y in zip(world.parts, shot.x.tolist(), shot.y.tolist(), strict=True)
        if not part.fixed and part.wheels is None
    )
    column, row = camera.cell(x, y)
    to = column + (6 if column < columns // 2 else -6), max(0, row - 2)
    return name, column + 1, row + 2, (to[0] + 1, to[1] + 2)


@pytest.mark.parametrize("size", [(80, 24), (160, 50)], ids=["80x24", "160x50"])
@pytest.mark.parametrize("scene", scene_ids())
def test_every_scene_opens_runs_answers_the_mouse_and_leaves_the_terminal_clean(
    terminal: Terminal, scene: str, size: tuple[int, int]
):
    name, column, row, to = highest(scene, size)

    def keep(what: str) -> None:
        (Path(terminal._socket).parent / f"{scene}-{size[0]}-{what}.txt").write_text(terminal.screen())

    terminal.start(scene)
    terminal.wait("Before it runs")
    keep("asked")
    terminal.keys("Escape")
    terminal.wait_until_gone("Before it runs")
    # Slowly, so that no run is over before the next key arrives.
    terminal.keys("-", "-", "-", "-", "-", "Space")
    terminal.wait("paused")
    keep("stopped")
    terminal.keys("r")
    terminal.wait("From the start")

    # While time stands still, a drag aims.
    terminal.mouse(0, column, row)
    terminal.mouse(32, (column + to[0]) // 2, row)
    terminal.mouse(32, *to)
    terminal.wait("aiming")
    keep("aiming")
    terminal.mouse(0, *to, "m")
    terminal.wait(f"{name} will fly at")
    terminal.keys("Space")
    terminal.wait("thrown")

    # While it runs, a hand holds.
    terminal.keys("r")
    terminal.wait("From the start")
    terminal.mouse(0, column, row)
    terminal.mouse(32, *to)
    terminal.wait(f"{name}: ")
    terminal.wait("Let go to throw it")
    terminal.mouse(0, *to, "m")
    keep("held")
    terminal.keys("q")
    terminal.wait("left after")
    assert terminal.state() == CLEAN
