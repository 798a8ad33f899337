"""Where a student is, and how they begin."""

from __future__ import annotations

import os
import re
import subprocess

import pytest

from tests.unit.cli.conftest import files_in


def test_the_dashboard_outside_of_a_workspace_says_how_to_begin(course):
    ran = course()
    assert ran.code == 0
    assert "course init" in ran.out


def test_the_dashboard_survives_a_damaged_record(course, workspace):
    (workspace / ".course" / "progress.sqlite").write_bytes(b"not a database, not at all, no" * 10)
    ran = course()
    assert ran.code == 0
    assert "progress.sqlite" in ran.err
    assert "Next: course doctor" in ran.out


def test_init_changes_nothing_in_a_workspace_where_a_file_is_or_where_course_toml_is_damaged(
    course, workspace
):
    before = files_in(workspace)
    ran = course("init", "inner", "--json")
    assert (ran.code, ran.json["error"]["code"]) == (2, "nested_workspace")
    assert not (workspace / "inner").exists()
    (workspace.parent / "in the way" / "course.toml").mkdir(parents=True)
    said = course("init", str(workspace.parent / "in the way")).err
    assert f"in the way{os.sep}course.toml is in the way." in said
    (workspace.parent / "file").write_text("x")
    assert course("init", str(workspace.parent / "file")).code == 2
    assert (workspace.parent / "file").read_text() == "x"
    assert files_in(workspace) == before
    marker = workspace / "course.toml"
    marker.write_text(marker.read_text().replace('"mini"', '"other"'))
    assert course("init", "--json").json["error"]["code"] == "other_course"
    marker.write_text("[[[")
    ran = course("init")
    assert ran.code == 2
    assert "course.toml:1" in ran.err
    assert (workspace / "course.toml").read_text() == "[[["


@pytest.mark.skipif(os.name == "nt", reason="names and quotes of another system")
@pytest.mark.parametrize("name", ["plain", 'ws "x" $HOME', "-dash", "it's"])
def test_the_way_into_a_new_workspace_can_be_pasted(course, tmp_path, name):
    said = course("init", "--", name).out
    (line,) = re.findall("^Go there: (.+)$", said, re.MULTILINE)
    script = f"{line} && pwd"
    ran = subprocess.run(["sh", "-c", script], cwd=tmp_path, capture_output=True, text=True, check=True)
    assert ran.stdout == f"{tmp_path / name}\n"


def test_start_and_init_never_overwrite_and_start_brings_back_what_was_removed(course, workspace, write):
    path = write("mine")
    before = files_in(workspace)
    ran = course("init")
    assert ran.code == 0
    assert "already" in ran.out
    assert files_in(workspace) == before
    ran = course("start", "doubling")
    assert ran.code == 0
    assert "was not changed" in ran.out
    assert path.read_bytes() == before[path]
    path.unlink()
    assert course("start", "doubling/").code == 0
    assert path.is_file()


@pytest.mark.parametrize(
    "command", ["start doubling", "go", "check", "hint", "diff", "submit", "progress", "watch", "update"]
)
def test_outside_of_a_workspace_a_command_says_how_to_make_one(course, command):
    ran = course(*command.split())
    assert ran.code == 5
    assert "course init" in ran.err
