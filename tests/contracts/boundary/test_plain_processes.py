"""What L1 stops and what it does not: the sentences of docs/grading.md about it, tried.

At L1 a submission is a process of the grader's own user. The rest of the corpus is run there too where
test_attacks.py says so; here is what only a level without walls makes worth trying.
"""

import os
import signal
import subprocess
import sys
import uuid
from time import monotonic, sleep

import pytest

from tests.contracts.boundary.levels import require_level
from tests.contracts.boundary.users import (
    IN_WORKERS,
    LEVELS_AND_USERS,
    ROOT,
    USERS,
    command_as,
    marked,
    run_as,
)

pytestmark = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="reads /proc")

_TRIAL = (
    IN_WORKERS
    + """
connection = connect(60)
print(connection.call("f"), flush=True)
connection.close()
found.close()
"""
)

_REACH = """
import os
def f():
    reached, parent = [], f"/proc/{os.getppid()}"
    for name in ("fd", "mem", "environ", "maps", "map_files", "cwd", "root", "ns/net"):
        try:
            path = f"{parent}/{name}"
            if name in ("fd", "map_files"):
                for entry in os.listdir(path):
                    os.close(os.open(f"{path}/{entry}", os.O_WRONLY))
            elif name in ("cwd", "root", "ns/net"):
                os.readlink(path)
            else:
                os.close(os.open(path, os.O_RDONLY))
            reached.append(name)
        except OSError:
            pass
    return reached
"""


@pytest.mark.parametrize("user", USERS)
def test_nothing_that_the_grader_has_open_is_reachable_through_proc(user):
    assert run_as(user, _TRIAL, "L1", _REACH).strip() == "[]"


_LEFT_OPEN = """
import os, signal, socket
def f():
    os.kill(os.getppid(), signal.SIGCONT)
    with open("SECRET") as handle:
        text = handle.read()
    with open("SECRET", "a") as handle:
        handle.write("changed")
    socket.create_server(("127.0.0.1", 0)).close()
    return text
"""


def test_what_is_said_to_be_open_is_open(tmp_path):
    """The row says so; were it no longer true, the row would have to be rewritten."""
    secret = tmp_path / "secret"
    secret.write_text("secret", "utf-8")
    user = "root" if os.getuid() == 0 else "ordinary"
    assert run_as(user, _TRIAL, "L1", _LEFT_OPEN.replace("SECRET", str(secret))).strip() == "secret"
    assert secret.read_text("utf-8") == "secretchanged"


_ENDLESS = {
    "asleep": "import time\ndef f():\n    print('x')\n    time.sleep(600)\n",
    "in C": "def f():\n    print('x')\n    return sum(range(10**11))\n",
    "deaf": "import signal, time\ndef f():\n    for n in (1, 2, 15):\n"
    "        signal.signal(n, signal.SIG_IGN)\n"
    "    while True:\n        time.sleep(1)\n",
}


@pytest.mark.parametrize(("level", "user"), LEVELS_AND_USERS)
def test_workers_end_with_a_grader_that_was_killed(level, user):
    require_level(level)
    for name, source in _ENDLESS.items() if level == "L1" else [("in C", _ENDLESS["in C"])]:
        marker = uuid.uuid4().hex
        # Whatever the grader starts inherits this, except what a launcher leaves out: it is put there too.
        program = (
            "from course.isolation import launch\n"
            "before = launch.environment\n"
            f"launch.environment = lambda: {{**before(), 'MARKER': '{marker}'}}\n" + _TRIAL
        )
        grader = subprocess.Popen(command_as(user, sys.executable, "-c", program, level, source), cwd=ROOT)
        try:
            _wait_until(lambda: len(marked(marker)) >= 2, f"{name}: no worker came")  # noqa: B023
            sleep(0.5)
        finally:
            grader.send_signal(signal.SIGKILL)
            grader.wait()
        _wait_until(lambda: not marked(marker), f"{name}: a worker outlived its grader")  # noqa: B023


def _wait_until(true, otherwise):
    end = monotonic() + 60  # a bound for the test, not a measure: it is met in milliseconds
    while monotonic() < end:
        if true():
            return
        sleep(0.05)
    pytest.fail(otherwise)
