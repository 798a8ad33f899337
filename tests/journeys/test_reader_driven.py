"""The reader in real terminals: every lesson to its last page, by keys and by mouse; and what goes wrong.

By hand: it takes minutes. ``COURSE_SCREENS=DIR`` keeps every screen that was seen.
"""

from __future__ import annotations

import contextlib
import os
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from course.catalog.load import Catalog
from course.progress.workspace import Workspace
from tests.terminals import Terminal, needs_tmux

pytestmark = [pytest.mark.soak, needs_tmux]

CATALOG = Catalog()
LESSON = "numerical-integration"
SIZES = [(80, 24), (120, 40), (40, 20)]
WHEEL_DOWN = 65
#: Where a program that has ended leaves the terminal: the usual screen, no mouse reports, a cursor.
AS_IT_WAS = "0 0 1"


@pytest.fixture
def workspace(tmp_path: Path) -> Workspace:
    return Workspace.create(tmp_path / "mine", CATALOG.course_id, CATALOG.version)


@pytest.fixture(params=SIZES, ids=["80x24", "120x40", "40x20"])
def terminal(request: pytest.FixtureRequest, workspace: Workspace) -> Iterator[Terminal]:
    with contextlib.closing(Terminal(workspace.root, request.param)) as made:
        yield made


def opened(terminal: Terminal, lesson: str = LESSON, before: str = "") -> str:
    terminal.line(f"{before} {sys.executable} -m course lesson {lesson}".strip())
    terminal.wait("Space on", "? keys")
    return terminal.still()


def foot(screen: str) -> str:
    return screen.rstrip("\n").splitlines()[-1]


def kept(screens: list[str], name: str) -> None:
    if folder := os.environ.get("COURSE_SCREENS"):
        Path(folder).mkdir(parents=True, exist_ok=True)
        Path(folder, f"{name}.txt").write_text("\n\f\n".join(screens), "utf-8")


@pytest.mark.parametrize("how", ["keys", "mouse"])
@pytest.mark.parametrize("lesson", CATALOG.lesson_ids())
def test_every_lesson_is_read_to_its_last_page(
    terminal: Terminal, workspace: Workspace, lesson: str, how: str, request: pytest.FixtureRequest
) -> None:
    screens = [opened(terminal, lesson)]
    while "You have read this lesson." not in screens[-1]:
        assert len(screens) < 400, screens[-1]
        if "Enter predict" in foot(screens[-1]):
            terminal.keys("s")
        elif how == "keys":
            terminal.keys("Space")
        else:
            for _ in range(3):
                terminal.mouse(WHEEL_DOWN, 10, 8)
        screens.append(terminal.wait_for_other(screens[-1]))
    kept(screens, request.node.name.replace("/", "-"))
    assert not any("Traceback" in foot(screen) or "\N{REPLACEMENT CHARACTER}" in screen for screen in screens)
    terminal.keys("q")
    terminal.wait("Next: course")
    assert terminal.state() == AS_IT_WAS
    assert [event.subject for event in workspace.store.events("lesson")] == [lesson]


@pytest.mark.parametrize("terminal", [(80, 24)], indirect=True, ids=["80x24"])
def test_without_colours_nothing_is_coloured_and_nothing_is_missing(terminal: Terminal) -> None:
    opened(terminal, before="NO_COLOR=1")
    for _ in range(12):
        screen = terminal.coloured()
        assert "\x1b[38;" not in screen
        assert "\x1b[48;" not in screen
        assert not any(f"\x1b[{code}m" in screen for code in (*range(31, 37), *range(41, 48)))
        terminal.keys("s" if "Enter predict" in screen else "Space")
        terminal.still()


@pytest.mark.parametrize("terminal", [(80, 24)], indirect=True, ids=["80x24"])
@pytest.mark.parametrize(
    "before", ["TERM=dumb", "LANG=C LC_ALL=C PYTHONUTF8=0 PYTHONCOERCECLOCALE=0", "TERM="]
)
def test_a_terminal_that_cannot_be_drawn_on_gets_the_lesson_in_lines(terminal: Terminal, before: str) -> None:
    terminal.line(f"env {before} {sys.executable} -m course lesson summary > all.txt; clear")
    terminal.still()
    terminal.line(f"env {before} {sys.executable} -m course lesson summary")
    screen = terminal.wait("Next: course")
    assert "\x1b" not in screen
    assert terminal.state() == AS_IT_WAS


@pytest.mark.parametrize("terminal", [(80, 24)], indirect=True, ids=["80x24"])
def test_a_cell_that_hangs_survives_other_sizes_and_is_stopped(terminal: Terminal) -> None:
    opened(terminal)
    to_a_cell(terminal)
    where = terminal.screen().splitlines()[0]
    terminal.keys("e")
    terminal.wait("Ctrl-R")
    terminal.keys("C-Home")
    terminal.type("while True: pass")
    terminal.keys("Enter")
    terminal.still()
    terminal.keys("C-r")
    terminal.wait("Ctrl-C stop it")
    for size in ((40, 20), (120, 40), (60, 12), (80, 24)):
        terminal.resize(*size)
        time.sleep(0.3)
        assert "Ctrl-C stop it" in foot(terminal.still()), terminal.screen()
    terminal.keys("C-c")
    terminal.wait("stopped", "Stopped")
    terminal.keys("q")
    terminal.wait("Next: course")
    assert terminal.state() == AS_IT_WAS
    assert opened(terminal).splitlines()[0] == where


def to_a_cell(terminal: Terminal) -> None:
    """Turn pages until a cell is at hand."""
    for _ in range(60):
        screen = terminal.still()
        if "r run" in foot(screen):
            return
        terminal.keys("s" if "Enter predict" in foot(screen) else "Space")
        terminal.wait_for_other(screen)
    pytest.fail(screen)


@pytest.mark.parametrize("terminal", [(80, 24)], indirect=True, ids=["80x24"])
@pytest.mark.parametrize(
    ("keys", "shows"),
    [
        ((), ""),
        (("t",), "before you start"),
        (("/",), "search"),
        (("?",), "keys"),
        (("e",), "ctrl-r"),
        (("r",), ""),
        (("Space", "Space", "Space"), ""),
    ],
    ids=["page", "contents", "search", "help", "editor", "running", "turning"],
)
def test_ctrl_c_anywhere_leaves_the_terminal_as_it_was_and_keeps_the_place(
    terminal: Terminal, keys: tuple[str, ...], shows: str
) -> None:
    opened(terminal)
    to_a_cell(terminal)
    where = terminal.still().splitlines()[0]
    for key in keys:
        terminal.keys(key)
    if shows:
        until = time.monotonic() + 20.0
        while shows not in terminal.screen().lower() and time.monotonic() < until:
            time.sleep(0.1)
    # A box, or a cell that runs, takes the first one and those that come before it is gone; then the reader.
    until = time.monotonic() + 40.0
    while "Next: course" not in (screen := terminal.screen()):
        assert time.monotonic() < until, screen
        terminal.keys("C-c")
        time.sleep(0.5)
    assert terminal.state() == AS_IT_WAS
    again = opened(terminal)
    if keys[:1] != ("Space",):
        assert again.splitlines()[0] == where
