"""The reader in real terminals: every lesson to its last page, by keys and by mouse, and one done in it.

There the student reads, predicts, runs a cell, changes one, starts a task, fails, asks for a hint, mends the
file in an editor and goes on; nothing but the editor is outside the reader. ``COURSE_SCREENS=DIR`` keeps the
screens of the lessons that are read.
"""

import contextlib
import os
import signal
import sys
import time
from functools import partial
from pathlib import Path

import pytest

from course.authoring.exercises.grading import mistakes_of, solution_path
from course.catalog.load import Catalog
from course.progress.workspace import Workspace
from tests.terminals import AS_IT_WAS, Terminal, needs_tmux

pytestmark = [pytest.mark.soak, needs_tmux]

#: What the shell shows last; a long command has a line of its own on a narrow terminal.
NEXT = ("Next: course", "Next:\ncourse")
LESSON = "numerical-integration"
CATALOG = Catalog()
WHEEL_DOWN = 65


@pytest.fixture
def workspace(tmp_path):
    return Workspace.create(tmp_path / "mine", CATALOG.course_id, CATALOG.version)


@pytest.fixture(params=[(80, 24), (120, 40), (40, 20)], ids=["80x24", "120x40", "40x20"])
def terminal(request, workspace):
    with contextlib.closing(Terminal(workspace.root, request.param)) as made:
        yield made


class Student:
    """Does what the line of keys at the foot of the screen offers."""

    def __init__(self, terminal, workspace):
        self.terminal, self.workspace = terminal, workspace
        self.done = []
        self.tasks = [one.id for one in CATALOG.tasks(LESSON)]
        self.left = list(self.tasks)

    def read_to_the_end(self):
        for _ in range(400):
            screen = self.terminal.still()
            keys = screen.rstrip("\n").splitlines()[-1]
            if "Enter predict" in keys:
                self.predict()
            # Where a message hides the keys, the mark at the question says as much.
            elif "Were you right?" in screen and ("were you 1" in keys or "▸ You said" in screen):
                self.terminal.keys("2")
                self.terminal.wait_for_other(screen)
                self.done.append("judged")
            elif "Enter start it" in keys:
                self.do_task(self.left.pop(0))
            elif "r run" in keys and self.done.count("ran") < 2:
                self.run()
            elif "Enter puts its file" in screen or "Were you right?" in screen:
                self.terminal.keys("Tab")  # a cell above it is at hand
                self.terminal.wait_for_other(screen)
            elif "You have read this lesson." in screen:
                return
            else:
                self.on(screen)
        pytest.fail(f"no end:\n{screen}")

    def on(self, screen):
        self.terminal.keys("Space")
        self.terminal.wait_for_other(screen)

    def predict(self):
        self.terminal.keys("Enter")
        self.terminal.wait("a number with its")
        self.terminal.type("it grows")
        self.terminal.keys("Enter")
        self.terminal.wait_until_gone("a number with its")  # what says "Kept." is soon gone itself
        self.done.append("predicted")

    def run(self):
        if "ran" not in self.done:
            self.terminal.keys("r")
            self.terminal.wait("ran here")
        else:
            self.terminal.keys("e")
            self.terminal.wait("Ctrl-R")
            self.terminal.keys("C-Home")
            self.terminal.type("print('mine', 6 * 7)")
            self.terminal.keys("Enter")
            self.terminal.still()
            self.terminal.keys("C-r")
            self.terminal.wait("mine 42")
        self.done.append("ran")

    def do_task(self, name):
        exercise = CATALOG.exercise(name)
        self.terminal.keys("Enter")
        self.terminal.wait("r check")
        path = self.workspace.path(exercise.place, exercise.module)
        assert path.is_file(), name
        self.terminal.keys("r")
        while "checked already" in self.begun(name, 1, lambda: self.terminal.keys("r")):  # the task before
            self.terminal.wait_until_gone("checked already")
            self.terminal.keys("r")
        self.checked(name, 1)
        self.terminal.keys("h")
        self.terminal.wait("The first hint follows")
        # A save is checked by itself, and so is one that comes while another is checked.
        solution, wrong = solution_path(CATALOG, exercise), mistakes_of(CATALOG, exercise).wrong
        model = solution.read_text("utf-8")
        path.write_text(wrong[0].composed(model, solution), "utf-8")
        self.checked(name, 2)
        self.terminal.keys("h")
        self.terminal.wait("Hint:")
        path.write_text(wrong[1].composed(model, solution), "utf-8")
        self.begun(name, 3, path.touch)
        path.write_bytes(solution.read_bytes())
        self.terminal.wait("Done: every check passes.")
        self.done.append(name)

    def begun(self, name, times, again):
        """The screen, once this check runs, or is over, which may be sooner than one looks, or is refused.

        A key that comes while a busy machine lays the page out anew can be lost: a student presses it again.
        """
        press = time.monotonic() + 10.0

        def began(screen):
            nonlocal press
            if time.monotonic() > press:
                press += 10.0
                again()
            seen = "Checking" in screen or "checked already" in screen
            return seen or len(self.workspace.store.events("check", name)) >= times

        return self.terminal.until(began)

    def checked(self, name, times):
        """Wait until the record has a check and the screen its answer."""
        checks = partial(self.workspace.store.events, "check", name)
        self.terminal.until(lambda screen: len(checks()) >= times and "Checking" not in screen, 60.0)


def test_a_lesson_is_read_and_done_from_its_title_to_its_last_line(terminal, workspace):
    terminal.line(f"{sys.executable} -m course lesson {LESSON}")
    terminal.wait("Space on")
    student = Student(terminal, workspace)
    student.read_to_the_end()
    assert student.left == []
    assert student.done.count("predicted") == student.done.count("judged") > 5
    terminal.keys("q")
    terminal.wait(*NEXT)
    events = workspace.store.events("check")
    passed = {event.subject for event in events if event.data["all_pass"]}
    assert passed == set(student.tasks)
    assert {event.subject for event in events if not event.data["all_pass"]} == passed


@pytest.mark.parametrize("terminal", [(80, 24)], indirect=True, ids=["80x24"])
@pytest.mark.parametrize("after", [0.0, 0.1, 0.15, 0.2, 0.25, 0.3, 0.5])
def test_a_window_that_closes_while_the_reader_ends_leaves_nothing_running(terminal, workspace, after):
    """Textual's thread that reads the keyboard went on, at full speed, where the terminal was gone."""
    terminal.line(f"sh -c 'echo $$ > pid; exec {sys.executable} -m course lesson {LESSON}'")
    terminal.wait("Space on")
    pid = int((workspace.root / "pid").read_text())
    terminal.keys("q")
    time.sleep(after)
    terminal.close()
    until = time.monotonic() + 30.0
    with contextlib.suppress(ProcessLookupError):
        while time.monotonic() < until:
            os.kill(pid, 0)
            time.sleep(0.1)
        os.kill(pid, signal.SIGKILL)
        pytest.fail("it still runs")


def opened(terminal, lesson=LESSON, before=""):
    terminal.line(f"{before} {sys.executable} -m course lesson {lesson}".strip())
    terminal.wait("Space on", "? keys")
    return terminal.still()


def foot(screen):
    return screen.rstrip("\n").splitlines()[-1]


def kept(screens, name):
    if folder := os.environ.get("COURSE_SCREENS"):
        Path(folder).mkdir(parents=True, exist_ok=True)
        Path(folder, f"{name}.txt").write_text("\n\f\n".join(screens), "utf-8")


@pytest.mark.parametrize("how", ["keys", "mouse"])
@pytest.mark.parametrize("lesson", CATALOG.lesson_ids())
def test_every_lesson_is_read_to_its_last_page(terminal, workspace, lesson, how, request):
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
    terminal.wait(*NEXT)
    assert terminal.state() == AS_IT_WAS
    assert [event.subject for event in workspace.store.events("lesson")] == [lesson]


@pytest.mark.parametrize("terminal", [(80, 24)], indirect=True, ids=["80x24"])
def test_without_colours_nothing_is_coloured_and_nothing_is_missing(terminal):
    opened(terminal, before="NO_COLOR=1")
    for _ in range(12):
        screen = terminal.coloured()
        assert "\x1b[38;" not in screen
        assert "\x1b[48;" not in screen
        assert not any(f"\x1b[{code}m" in screen for code in (*range(31, 37), *range(41, 48)))
        terminal.keys("s" if "Enter predict" in screen else "Space")
        terminal.still()


def to_a_cell(terminal):
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
def test_ctrl_c_anywhere_leaves_the_terminal_as_it_was_and_keeps_the_place(terminal, keys, shows):
    opened(terminal)
    to_a_cell(terminal)
    where = terminal.still().splitlines()[0]
    for key in keys:
        terminal.keys(key)
    terminal.until(lambda screen: shows in screen.lower(), 20.0)

    def left(screen):
        if not (over := any(words in screen for words in NEXT)):
            terminal.keys("C-c")
            time.sleep(0.5)
        return over

    # A box, or a cell that runs, takes the first one and those that come before it is gone; then the reader.
    terminal.until(left)
    assert terminal.state() == AS_IT_WAS
    again = opened(terminal)
    if keys[:1] != ("Space",):
        assert again.splitlines()[0] == where
