"""Where a student is, and how they begin."""

from __future__ import annotations

import pytest

from course.progress.store import Store
from tests.unit.cli.conftest import files_in


def test_the_dashboard_outside_of_a_workspace_says_how_to_begin(course):
    ran = course()
    assert ran.code == 0
    assert "course init" in ran.out


def test_the_dashboard_names_the_next_step(course, workspace, write):
    Store(workspace / ".course" / "progress.sqlite").append("lesson", "twice-as-much")
    assert "Next: course check doubling" in course().out
    write("RIGHT", "RIGHT")
    course("check")
    ran = course()
    assert "every public check passes" in ran.out
    assert "Next: course start halving" in ran.out


def test_the_dashboard_survives_a_damaged_record(course, workspace):
    (workspace / ".course" / "progress.sqlite").write_bytes(b"not a database, not at all, no" * 10)
    ran = course()
    assert ran.code == 0
    assert "progress.sqlite" in ran.err
    assert "Next: course doctor" in ran.out


def test_init_twice_changes_nothing_and_says_so(course, workspace):
    before = files_in(workspace)
    ran = course("init")
    assert ran.code == 0
    assert "already" in ran.out
    assert files_in(workspace) == before


def test_init_inside_a_workspace_is_refused(course, workspace):
    ran = course("init", "inner", "--json")
    assert (ran.code, ran.json["error"]["code"]) == (2, "nested_workspace")
    assert not (workspace / "inner").exists()


def test_init_leaves_a_damaged_course_toml_alone(course, workspace):
    (workspace / "course.toml").write_text("[[[")
    ran = course("init")
    assert ran.code == 2
    assert "course.toml:1" in ran.err
    assert (workspace / "course.toml").read_text() == "[[["


def test_init_where_a_file_is_in_the_way_says_so(course, tmp_path):
    (tmp_path / "file").write_text("x")
    assert course("init", "file").code == 2
    assert (tmp_path / "file").read_text() == "x"


def test_start_never_overwrites(course, workspace, write):
    path = write("mine")
    before = path.read_bytes()
    ran = course("start", "doubling")
    assert ran.code == 0
    assert "was not changed" in ran.out
    assert path.read_bytes() == before


def test_start_brings_back_what_was_removed(course, workspace):
    (workspace / "doubling" / "doubling.py").unlink()
    assert course("start", "doubling/").code == 0
    assert (workspace / "doubling" / "doubling.py").is_file()


@pytest.mark.parametrize(
    "command", ["start doubling", "go", "check", "hint", "diff", "submit", "progress", "watch", "update"]
)
def test_outside_of_a_workspace_a_command_says_how_to_make_one(course, command):
    ran = course(*command.split())
    assert ran.code == 5
    assert "course init" in ran.err


def test_a_new_workspace_names_the_command_that_the_readme_names(course, tmp_path):
    assert course("init", "mine", "--json").json["next"]["command"] == "course go"
    assert "course go" in course("init", "yours").out
