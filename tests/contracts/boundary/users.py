"""Runs a piece of Python as root and as an ordinary user: what holds for one need not hold for the other."""

import contextlib
import functools
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.turns import soak_unless

ROOT = Path(__file__).resolve().parents[3]
#: "ordinary" is whoever runs the tests, or user 1000 of a new user namespace if that is root: files of the
#: tester's stay readable there, and every capability is gone.
USERS = ("root", "ordinary")
#: Values of ``level`` and ``user``: each level with each user, in an ordinary run with one of them.
LEVELS_AND_USERS = soak_unless(
    [("L1", "ordinary"), ("L2", "root"), ("L3", "ordinary")],
    [(level, user) for level in ("L1", "L2", "L3") for user in USERS],
)

#: The head of a program that is told a level and a source: what calls that source in workers.
IN_WORKERS = """
import sys
from course.isolation.failures import StudentFailure
from course.isolation.launch import keep_private
from course.isolation.levels import Deadline, Level
from course.isolation.session import Connection
from course.isolation.spawn import spawner
keep_private()
found = spawner(Level(sys.argv[1]), ("numpy",))
def connect(seconds):
    return Connection(found, {"a.py": sys.argv[2].encode()}, "a.py", Deadline(seconds))
"""


def command_as(user, *command):
    """The command as that user; skips the calling test where it cannot be run so."""
    if (os.getuid() == 0) == (user == "root"):
        return list(command)
    if user == "root" or not _can_unshare():
        pytest.skip(f"no way to be {user} here")
    return ["unshare", "--user", "--map-user=1000", "--map-group=1000", *command]


def run_as(user, program, *arguments):
    """What a program prints, run with the course importable."""
    done = subprocess.run(
        command_as(user, sys.executable, "-c", program, *arguments),
        capture_output=True,
        text=True,
        cwd=ROOT,
        timeout=120,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def marked(marker):
    """Living processes with this in their environment.

    Of one that belongs to another user or may not be looked at nothing can be said here.
    """
    found = set()
    for entry in Path("/proc").glob("[0-9]*"):
        with contextlib.suppress(OSError):
            ended = (entry / "stat").read_text("utf-8", "replace").rpartition(")")[2].split()[0] == "Z"
            if not ended and marker.encode() in (entry / "environ").read_bytes():
                found.add(int(entry.name))
    return found


@functools.cache
def _can_unshare():
    if shutil.which("unshare") is None:
        return False
    return subprocess.run(["unshare", "--user", "true"], capture_output=True, check=False).returncode == 0
