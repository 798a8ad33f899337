"""Folders of sessions: one's own is private, a killed one's is deleted by the next."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from pathlib import Path

import pytest

from course.isolation.launch import private_folder

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="a process cannot be asked if it lives")


def test_folders_of_dead_processes_go_and_those_of_living_ones_stay(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    ended = subprocess.Popen([sys.executable, "-c", ""])
    ended.wait()
    dead = tmp_path / f"course-worker-{ended.pid}-x"
    living = tmp_path / f"course-worker-{os.getppid()}-x"
    strange = tmp_path / "course-worker-notes"
    for folder in (dead, living, strange):
        folder.mkdir()
        (folder / "file").write_text("x", "utf-8")
    own = private_folder()
    assert own.stat().st_mode & 0o077 == 0
    assert sorted(tmp_path.iterdir()) == sorted([living, own, strange])
