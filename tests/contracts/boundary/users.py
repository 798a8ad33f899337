"""Runs a piece of Python as root and as an ordinary user: what holds for one need not hold for the other."""

from __future__ import annotations

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


def command_as(user: str, *command: str) -> list[str]:
    """The command as that user; skips the calling test where it cannot be run so."""
    if (os.getuid() == 0) == (user == "root"):
        return list(command)
    if user == "root" or not _can_unshare():
        pytest.skip(f"no way to be {user} here")
    return ["unshare", "--user", "--map-user=1000", "--map-group=1000", *command]


def run_as(user: str, program: str, *arguments: str) -> str:
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


@functools.cache
def _can_unshare() -> bool:
    if shutil.which("unshare") is None:
        return False
    return subprocess.run(["unshare", "--user", "true"], capture_output=True, check=False).returncode == 0
