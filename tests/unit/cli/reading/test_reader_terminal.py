"""The reader in a real terminal: one lesson as a student reads it, and the line it comes back to."""

import contextlib
import os
import signal
import sys
import time

import pytest

from tests.command_line import in_process
from tests.terminals import AS_IT_WAS, Terminal, needs_tmux

pytestmark = needs_tmux
LESSON = "numerical-integration"


@pytest.fixture
def terminal(mine):
    with contextlib.closing(Terminal(mine.root, (80, 24))) as made:
        yield made


def test_a_student_reads_predicts_runs_and_comes_back_to_the_line(terminal, mine):
    store = mine.store
    terminal.line(f"sh -c 'echo $$ > pid; exec {sys.executable} -m course lesson {LESSON}'")
    terminal.wait("min left")
    terminal.type("G")
    terminal.wait("You have read this lesson")
    terminal.type("g")
    terminal.wait_until_gone("You have read this lesson")
    while "Enter predict" not in (screen := terminal.still()):
        terminal.keys("Space")
        terminal.wait_for_other(screen)
    terminal.keys("Enter")
    terminal.wait("keep it and open")
    terminal.type("half a metre")
    terminal.keys("Enter")
    terminal.wait("You said")
    until = time.monotonic() + 40.0
    while not store.events("prediction") and time.monotonic() < until:
        time.sleep(0.1)
    assert store.events("prediction", LESSON)[-1].data["text"] == "half a metre"
    terminal.type("r")
    terminal.wait("prints the same")
    terminal.resize(60, 30)
    terminal.type("j")
    terminal.still()
    os.kill(int((mine.root / "pid").read_text()), signal.SIGTERM)  # a closed window: the place is kept
    terminal.wait("Next: course")
    assert terminal.state() == AS_IT_WAS
    assert store.events("cell", LESSON)[-1].data["error"] == ""
    assert store.events("lesson", LESSON)
    place = store.events("bookmark", LESSON)[-1].data
    assert place["block"] > 0
    terminal.line(f"clear; {sys.executable} -m course lesson {LESSON}")
    terminal.wait("min left")
    terminal.keys("C-c")
    terminal.wait("Next: course")
    assert store.events("bookmark", LESSON)[-1].data["block"] == place["block"]


def test_a_reader_may_leave_while_a_cell_runs(terminal):
    terminal.line(f"{sys.executable} -m course lesson why-simulate")
    terminal.wait("min left")
    while "r run" not in (screen := terminal.still()):
        terminal.type("s" if "s skip" in screen else " ")
        terminal.wait_for_other(screen)
    terminal.type("e")
    terminal.wait("keep, run")
    terminal.keys("C-End")
    terminal.type("; [0 for _ in iter(int, 1)]")
    terminal.keys("C-r")
    terminal.wait("the cell runs")
    terminal.type("q")
    terminal.wait("Next: course")
    assert terminal.state() == AS_IT_WAS


def test_after_a_lesson_in_watch_a_stop_and_fg_go_on(terminal, mine):
    assert in_process("-C", mine.root, "start", "integrators").returncode == 0
    terminal.line(f"{sys.executable} -m course watch integrators")
    terminal.wait("q leave")
    for _ in range(2):
        terminal.type("l")
        terminal.wait("min left")
        terminal.type("q")
        terminal.wait_until_gone("min left")
        terminal.still()
        terminal.keys("C-z")
        terminal.wait("Stopped")
        terminal.line("clear; fg")
        terminal.wait_until_gone("Stopped")
    terminal.type("q")
    terminal.line("echo left $?")
    terminal.wait("left 0")
    assert terminal.state() == AS_IT_WAS


@pytest.mark.parametrize(
    "before", ["TERM=dumb", "LANG=C LC_ALL=C PYTHONUTF8=0 PYTHONCOERCECLOCALE=0", "TERM="]
)
def test_a_terminal_that_cannot_be_drawn_on_gets_the_printed_lesson(terminal, mine, before):
    terminal.line(f"env {before} {sys.executable} -m course lesson why-simulate")  # few figures to draw
    assert "\x1b" not in terminal.wait("Next: course")
    assert terminal.state() == AS_IT_WAS
    assert not mine.store.events("lesson")
