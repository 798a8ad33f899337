"""A student's way through an exercise, as they walk it, with the real sandbox.

A command is a process where its terminal, its signals or a second program matter; the walk with a process
for each is test_student.py.
"""

import json
import os
import re
import shutil
import signal
import subprocess
import sys
import zipfile
from functools import partial
from pathlib import Path

import pytest

from tests.command_line import as_process, in_process

pytestmark = pytest.mark.usefixtures("sandboxes")
ROOT = Path(__file__).resolve().parents[2]
MINI_COURSE = ROOT / "tests" / "fixtures" / "mini_course"
WRONG = "def double(x):\n    return x * x\n\n\ndef doublings(x, n):\n    return [x]\n"
HALF = "def double(x):\n    return x + x\n\n\ndef doublings(x, n):\n    return [x]\n"
RIGHT = HALF.replace("[x]", "[x * 2**k for k in range(n + 1)]")
RAISING = RIGHT.replace("return x + x", "print('hello')\n    raise ValueError('no')")


@pytest.fixture
def content(tmp_path):
    """The miniature course as a student has it: no solutions, no graders."""
    folder = tmp_path / "content"
    for name in ("exercises", "lessons"):
        shutil.copytree(MINI_COURSE / name, folder / name)
    return folder


@pytest.fixture
def course(content, tmp_path):
    """Run a command line in ``tmp_path``; whatever it is, no traceback reaches the screen."""
    environ = {
        key: value
        for key, value in os.environ.items()
        if key not in {"FORCE_COLOR", "NO_COLOR", "PYTHONPATH", "COURSE_CONTENT"}
    }
    environ |= {"PYTHONPATH": str(ROOT), "COURSE_CONTENT": str(content), "PYTHONUTF8": "1"}

    def run(*words, cwd=None, way=in_process, **extra):
        ran = way(*words, cwd=cwd or tmp_path, env={**environ, **extra})
        assert "Traceback (most recent call last)" not in ran.stdout + ran.stderr
        return ran

    run.environ = environ
    return run


@pytest.fixture
def process(course):
    """Run a command line as a process."""
    return partial(course, way=as_process)


@pytest.fixture
def workspace(course, tmp_path):
    root = tmp_path / "my work é"
    assert course("init", str(root)).returncode == 0
    assert course("start", "doubling", cwd=root).returncode == 0
    return root


def test_the_whole_way_from_init_to_submit(course, tmp_path):
    root = tmp_path / "work"
    assert _next(course("init", "work"), "Then: ") == ["go"]
    step = _next(course(cwd=root))
    assert step == ["start", "doubling"], "doing comes first"
    step = _next(course(*step, cwd=root), "Then check it on every save: ")
    assert step[:2] == ["watch", "doubling"]
    assert course("check", cwd=root).returncode == 1

    module = root / "doubling" / "doubling.py"
    module.write_text(WRONG)
    failed = course("check", cwd=root)
    assert failed.returncode == 1
    step = _next(failed)
    assert step == ["hint", "doubling"]
    first = course(*step, cwd=root)
    assert course(*step, cwd=root).stdout.splitlines()[1] == first.stdout.splitlines()[1]

    module.write_text(RIGHT)
    passed = course("check", cwd=root)
    assert passed.returncode == 0
    assert "All 2 public checks pass; 2 hidden checks run when it is graded." in passed.stdout
    assert course("solution", cwd=root).returncode == 5
    step = _next(passed)
    assert step == ["submit"]
    assert course(*step, cwd=root).returncode == 0
    with zipfile.ZipFile(root / "mini-submission.zip") as archive:
        assert archive.read("doubling/doubling.py").decode() == RIGHT
    assert module.read_text() == RIGHT
    assert "every public check passes" in course("progress", cwd=root).stdout


@pytest.mark.parametrize(
    ("source", "exit_code", "says"),
    [
        (b"", 3, "none of the functions"),
        (b"def double(x:\n", 3, "line 1"),
        (b"import not_there_at_all\nx = len(not_there_at_all.x)\n", 3, "not_there_at_all"),
        (b"raise SystemExit(0)\n", 3, "doubling.py"),
        (b"\x00\x01\xff", 3, "doubling.py"),
        (HALF.encode(), 1, "There is one value more"),
        ("\ufeff".encode() + RIGHT.replace("\n", "\r\n").encode(), 0, "All 2"),
        (b"def double(x):\n    return x + x\n", 1, "doublings"),
        (RAISING.encode(), 1, "ValueError"),
    ],
)
def test_a_file_in_any_state_gets_an_answer(course, workspace, source, exit_code, says):
    (workspace / "doubling" / "doubling.py").write_bytes(source)
    ran = course("check", "doubling", cwd=workspace)
    assert ran.returncode == exit_code
    assert says in ran.stdout + ran.stderr
    assert (workspace / "doubling" / "doubling.py").read_bytes() == source


def test_a_workspace_behind_a_link_works(course, workspace, tmp_path):
    link = tmp_path / "link"
    link.symlink_to(workspace, target_is_directory=True)
    (link / "doubling" / "doubling.py").write_text(RIGHT)
    assert course("check", cwd=link / "doubling").returncode == 0
    assert course("-C", str(link), "submit").returncode == 0


@pytest.mark.parametrize(
    "extra", [{"NO_COLOR": "1", "FORCE_COLOR": "1"}, {"TERM": "dumb"}, {"FORCE_COLOR": "1"}, {}]
)
def test_colour_is_where_it_was_asked_for(process, workspace, extra):
    words = process("check", cwd=workspace, COLUMNS="60", **extra).stdout
    coloured = re.search(r"\x1b\[[0-9;]*3[1-7]", words) is not None
    assert coloured is (extra == {"FORCE_COLOR": "1"})
    if "FORCE_COLOR" in extra:
        assert max(len(re.sub(r"\x1b\[[0-9;?]*[A-Za-z]", "", row)) for row in words.splitlines()) <= 60


def test_a_check_while_a_watch_runs_loses_nothing(course, workspace):
    module = workspace / "doubling" / "doubling.py"
    with _watch(course, workspace) as watch:
        for number in range(3):
            module.write_text(RIGHT + f"# {number}\n" + f"a{number} = 1\n")
            assert course("check", cwd=workspace).returncode == 0
        module.write_text(HALF)
        watch.wait_for("Score 2")  # interrupted before that, it may have recorded a run that it has not told
        runs = watch.stop()["runs"]
    body = json.loads(course("progress", "--json", cwd=workspace).stdout)
    assert body["exercises"][0]["checks_run"] == len(runs) + 3


class _watch:  # noqa: N801 - a context manager, used like a function
    """A watch of ``doubling``, warm before it is handed over."""

    def __init__(self, course, workspace):
        self.process = subprocess.Popen(
            [sys.executable, "-u", "-m", "course", "watch", "doubling", "--json"],
            cwd=workspace,
            env=course.environ,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            encoding="utf-8",
        )
        self.wait_for("Score")

    def wait_for(self, words):
        """Read what it says until a line begins with ``words``."""
        for line in self.process.stderr:
            assert "Traceback" not in line
            if line.startswith(words):
                return
        raise AssertionError(f"the watch ended without saying {words!r}")

    def stop(self):
        """Interrupt it and return its one object."""
        self.process.send_signal(signal.SIGINT)
        out, _ = self.process.communicate(timeout=30)
        return json.loads(out)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.process.kill()
        self.process.communicate()


def _next(ran, label="Next: "):
    """The words of the command that the output suggests."""
    line = next(line for line in ran.stdout.splitlines() if line.startswith(label))
    return line.removeprefix(label).split("(")[0].split()[1:]
