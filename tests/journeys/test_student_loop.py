"""An exercise worked on behind a link, and by two commands at once, with the real sandbox."""

import json
import shutil
import signal
import subprocess
from dataclasses import replace

import pytest

from tests.journeys.conftest import ROOT

pytestmark = pytest.mark.usefixtures("sandboxes")
MINI_COURSE = ROOT / "tests" / "fixtures" / "mini_course"
HALF = "def double(x):\n    return x + x\n\n\ndef doublings(x, n):\n    return [x]\n"
RIGHT = HALF.replace("[x]", "[x * 2**k for k in range(n + 1)]")


@pytest.fixture
def course(instructor, tmp_path):
    """Commands on the miniature course as a student has it: no solutions, no graders."""
    for name in ("exercises", "lessons"):
        shutil.copytree(MINI_COURSE / name, tmp_path / "content" / name)
    content = {"COURSE_CONTENT": str(tmp_path / "content")}
    return replace(instructor, environment=instructor.environment | content)


@pytest.fixture
def workspace(course, tmp_path):
    root = tmp_path / "my work é"
    course("init", root)
    course("start", "doubling", cwd=root)
    return root


def test_a_workspace_behind_a_link_works(course, workspace, tmp_path):
    link = tmp_path / "link"
    link.symlink_to(workspace, target_is_directory=True)
    (link / "doubling" / "doubling.py").write_text(RIGHT)
    course("check", cwd=link / "doubling")
    course("-C", link, "submit")


def test_a_check_while_a_watch_runs_loses_nothing(course, workspace):
    module = workspace / "doubling" / "doubling.py"
    watch = subprocess.Popen(
        [*course.command, "watch", "doubling", "--json"],
        cwd=workspace,
        env=course.environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        encoding="utf-8",
    )
    with watch:
        said_in_time(watch, "Score")  # it is warm
        for number in range(3):
            module.write_text(RIGHT + f"# {number}\n" + f"a{number} = 1\n")
            course("check", cwd=workspace)
        module.write_text(HALF)
        said_in_time(watch, "Score 2")  # interrupted before, it may have recorded a run that it has not told
        watch.send_signal(signal.SIGINT)
        runs = json.loads(watch.communicate(timeout=30)[0])["runs"]
    body = json.loads(course("progress", "--json", cwd=workspace).stdout)
    assert body["exercises"][0]["checks_run"] == len(runs) + 3


def said_in_time(watch, words):
    """Read what a watch says until a line begins with ``words``."""
    for line in watch.stderr:
        assert "Traceback" not in line
        if line.startswith(words):
            return
    pytest.fail(f"the watch ended without saying {words!r}")
