"""The same lesson by typed lines with ``--plain``, as with a screen reader, from its title to its last line.

What the terminal is sent is kept byte for byte: nothing in it moves a cursor or draws anything again.
"""

import contextlib
import os
import select
import sys
import time

import pytest

from course.authoring.exercises.grading import mistakes_of, solution_path
from course.catalog.load import Catalog
from course.progress.workspace import Workspace
from tests.unit.cli.reading.test_by_line import repeated

pty = pytest.importorskip("pty")
LESSON = "numerical-integration"
CATALOG = Catalog()
#: In s; a machine that runs other tests beside this one is slow to check.
PATIENCE = 120.0
PREDICT = "Your prediction; Enter skips it: "
ENDS = (PREDICT, "q stops: ", "Enter goes on: ")


class Lines:
    """A program on a terminal that shows what arrives and nothing else."""

    def __init__(self, folder, *words, command=(sys.executable, "-m", "course"), environment=os.environ):
        self.said = b""
        self._from = 0
        self.pid, self._terminal = pty.fork()
        if self.pid == 0:
            os.chdir(folder)
            terminal = {"TERM": "xterm-256color", "LC_ALL": "C.UTF-8", "COLORTERM": "truecolor"}
            os.execve(command[0], [*command, *words], {**environment, "LANG": "C.UTF-8", **terminal})

    def wait(self, *ends):
        """What was said since the last wait, once it ends with one of these or the program has ended."""
        until = time.monotonic() + PATIENCE
        while time.monotonic() < until:
            if select.select([self._terminal], [], [], 0.1)[0]:
                try:
                    self.said += os.read(self._terminal, 1 << 16)
                except OSError:  # it has ended
                    break
            elif self.said[self._from :].decode("utf-8", "replace").endswith(ends):
                break
        else:
            pytest.fail(f"{ends} did not come after: {self.said[-2000:].decode('utf-8', 'replace')}")
        new = self.said[self._from :].decode().replace("\r\n", "\n")
        self._from = len(self.said)
        return new

    def type(self, words, *ends):
        os.write(self._terminal, f"{words}\n".encode())
        return self.wait(*(ends or ENDS)).partition("\n")[2]  # the terminal shows what was typed

    def press(self, key, *ends):
        """A key without Enter, and what it says; all of it if the program ends."""
        os.write(self._terminal, key.encode())
        return self.wait(*ends)

    def interrupt(self):
        os.write(self._terminal, b"\x03")
        return self.wait(*ENDS)

    def close(self):
        os.close(self._terminal)
        with contextlib.suppress(ChildProcessError):
            os.waitpid(self.pid, 0)


@pytest.fixture
def workspace(tmp_path):
    return Workspace.create(tmp_path / "mine", CATALOG.course_id, CATALOG.version)


@pytest.fixture
def lines(workspace):
    with contextlib.closing(Lines(workspace.root, "lesson", LESSON, "--plain", "--page")) as made:
        yield made


def once(said):
    """The same, which says no sentence twice."""
    assert repeated(said) == []
    return said


def cell(lines, workspace):
    """Run a cell, change it, run it, hang it, stop it, and take the lesson's own again."""
    assert "and printed the same." in lines.type("r")
    lines.type("e")
    (path,) = workspace.root.glob(f"{LESSON}-*.py")
    path.write_text(path.read_text("utf-8") + "\nprint('mine', 6 * 7)\n", "utf-8")
    assert "mine 42\nEnd of output\n" in once(lines.type("r"))
    path.write_text("print('begun', flush=True)\nwhile True:\n    pass\n", "utf-8")
    assert "runs; Ctrl-C stops it." in lines.type("r", "stops it.\r\n")
    stopped = lines.interrupt()
    assert "begun\nEnd of output\n" in stopped
    assert "Stopped.\n" in stopped
    assert "The lesson's own code is back." in lines.type("u")
    assert "and printed the same." in lines.type("r")


def task(lines, workspace, name):
    """Start it, fail, ask for a hint, fail otherwise, ask again, mend it."""
    exercise = CATALOG.exercise(name)
    path = workspace.path(exercise.place, exercise.module)
    once(lines.type("start"))
    assert path.is_file()
    once(lines.type("check"))
    assert "hint" in once(lines.type("hint")).lower()
    solution, wrong = solution_path(CATALOG, exercise), mistakes_of(CATALOG, exercise).wrong
    model = solution.read_text("utf-8")
    path.write_text(wrong[0].composed(model, solution), "utf-8")
    once(lines.type("check"))
    assert len(once(lines.type("hint")).split()) > 5
    path.write_bytes(solution.read_bytes())
    once(lines.type("check"))
    passed = [event.data["all_pass"] for event in workspace.store.events("check", name)]
    assert passed == [False, False, True]


def test_a_lesson_is_read_and_done_by_lines(lines, workspace):
    said, left, done = lines.wait(*ENDS), [one.id for one in CATALOG.tasks(LESSON)], []
    while "Next: course" not in said.splitlines()[-1]:
        once(said)
        prompt = said.splitlines()[-1]
        offered = said.splitlines()[-2]
        if prompt == PREDICT:
            said = lines.type("it grows")
            done.append("predicted")
            continue
        if "1 2 3 say" in offered:
            assert "Kept: nearly right." in lines.type("2")
            done.append("judged")
        if "r runs cell" in offered and "cell" not in done:
            cell(lines, workspace)
            done.append("cell")
        if "start puts its file" in offered:
            task(lines, workspace, left.pop(0))
        said = lines.type("", *ENDS, f"Next: course lesson {LESSON}\r\n")
    assert left == []
    assert done.count("predicted") == done.count("judged") > 5
    assert b"\x1b" not in lines.said
    assert [event.subject for event in workspace.store.events("lesson")] == [LESSON]


def test_ctrl_c_keeps_the_place(lines, workspace):
    lines.wait(*ENDS)
    lines.type("")
    page = lines.type("")
    lines.interrupt()
    with contextlib.closing(Lines(workspace.root, "lesson", LESSON, "--plain", "--page")) as again:
        back = again.wait(*ENDS)
        again.interrupt()
    assert back.startswith("Going on with page 3 of ")
    assert page.strip() in back
