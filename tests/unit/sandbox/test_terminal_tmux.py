"""The view in a real terminal: tmux, with keys and a mouse as a terminal sends them."""

import contextlib
import os
import signal
import sys
import time

import pytest

from course.sandbox.scene.loading import choose, scene_ids
from course.sandbox.views.terminal.picture import Camera
from course.sandbox.world.world import World
from tests.terminals import AS_IT_WAS, Terminal, needs_tmux

pytestmark = [pytest.mark.soak, needs_tmux]

PLAY = """
import os
import sys
from pathlib import Path
from course.sandbox.scene.loading import choose
from course.sandbox.views.terminal.view import play
from course.sandbox.world.world import World
if "--fail" in sys.argv:
    def broken(world):
        raise RuntimeError("broken on purpose")
    World.drain_events = broken
Path("pid").write_text(str(os.getpid()))
play(choose(sys.argv[1]))
print("left the scene")
"""


def start(terminal, *arguments):
    terminal.line(f"{sys.executable} play.py {' '.join(arguments)}")


@pytest.fixture
def size():
    return 80, 24


@pytest.fixture
def terminal(tmp_path, size):
    (tmp_path / "play.py").write_text(PLAY, encoding="utf-8")
    made = Terminal(tmp_path, size)
    with contextlib.closing(made):
        yield made


@pytest.mark.parametrize("how", ["C-c", "INT", "TERM", "HUP"])
def test_the_terminal_is_left_clean_however_one_leaves(terminal, tmp_path, how):
    start(terminal, "newtons-cradle")
    terminal.wait("o scenes")
    if how == "C-c":
        terminal.keys("C-c")
    else:
        os.kill(int((tmp_path / "pid").read_text()), getattr(signal, f"SIG{how}"))
    terminal.wait("left the scene")
    assert terminal.state() == AS_IT_WAS


def test_the_terminal_is_left_clean_after_an_error_which_is_reported_once(terminal):
    start(terminal, "head-on", "--fail")
    terminal.wait("RuntimeError: broken on purpose")
    time.sleep(0.5)
    assert terminal.screen().count("\nRuntimeError: broken on purpose") == 1
    assert terminal.state() == AS_IT_WAS


def highest(scene, size):
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
def test_every_scene_opens_runs_answers_the_mouse_and_leaves_the_terminal_clean(terminal, scene, size):
    name, column, row, to = highest(scene, size)
    start(terminal, scene)
    terminal.wait("o scenes")
    # Slowly, so that bodies are where they began when a hand takes one.
    terminal.keys("-", "-", "-", "-", "-", "Space")
    terminal.wait("paused")
    terminal.keys("r")
    terminal.wait("From the start")

    # While time stands still, a drag places.
    terminal.mouse(0, column, row)
    terminal.mouse(32, (column + to[0]) // 2, row)
    terminal.mouse(32, *to)
    terminal.mouse(0, *to, "m")
    terminal.wait(f"{name} stays there")
    terminal.keys("u")

    # While it runs, a hand holds.
    terminal.keys("r", "Space")
    terminal.wait_until_gone("paused")
    terminal.mouse(0, column, row)
    terminal.mouse(32, *to)
    terminal.wait("Let go to throw it")
    terminal.mouse(0, *to, "m")
    terminal.keys("q")
    terminal.wait("left the scene")
    assert terminal.state() == AS_IT_WAS
