"""How an exercise begins, the stub and newer versions of it; nothing is lost on the way."""

import os
import re
import subprocess
from pathlib import Path

import pytest

from tests.unit.cli.conftest import files_in


def test_diff_shows_lines_added_and_removed_or_says_that_there_are_none(course, write, workspace):
    course("diff").ends(0, "as it was handed out")
    path = workspace / "doubling" / "doubling.py"
    path.write_text(path.read_text() + "# one more\n")
    assert "1 line added, 0 removed." in course("diff").out
    write("RIGHT", "wrong")
    body = course("diff --json").json
    assert body["changed"]
    assert "+    'RIGHT'" in body["diff"]
    assert body["added"] == sum(row.startswith("+") for row in body["diff"].splitlines()[2:])


def test_reset_asks_nobody_but_needs_yes_and_keeps_a_copy_whose_path_it_prints(course, workspace, write):
    path = write("mine")
    before = path.read_bytes()
    assert course("reset doubling --json").error == (2, "needs_yes")
    assert path.read_bytes() == before
    body = course("reset doubling --yes --json").json
    copy = workspace / body["backups"][0]["backup"]
    assert copy.read_bytes() == before
    assert "NotImplementedError" in path.read_text()
    assert "nothing was changed" in course("reset doubling").out


def test_reset_of_an_exercise_that_was_not_started_makes_nothing_of_it(course, workspace):
    before = files_in(workspace)
    ran = course("reset halving --yes --json").warns("course start halving")
    assert ran.error == (5, "not_started")
    assert files_in(workspace) == before


def test_reset_writes_nothing_if_the_copy_cannot_be_made(course, workspace, write):
    path = write("mine")
    before = path.read_bytes()
    (workspace / ".course" / "backups").write_text("a file where a folder should be")
    assert course("reset doubling --yes").code == 4
    assert path.read_bytes() == before


@pytest.fixture
def newer_content(students_content):
    """The same course, one version later: another README and another stub for doubling."""
    syllabus = students_content / "lessons" / "syllabus.toml"
    text = syllabus.read_text()
    lines = [line for line in text.splitlines() if not line.startswith("version")]
    syllabus.write_text("\n".join([lines[0], 'version = "9.0.0"', *lines[1:]]) + "\n")
    folder = students_content / "exercises" / "doubling"
    for name in ("README.md", "doubling.py"):
        (folder / name).write_text((folder / name).read_text() + "\n# newer\n")
    return students_content


def test_update_replaces_what_was_not_edited_and_puts_the_rest_beside(
    course, workspace, write, newer_content
):
    mine = write("mine").read_bytes()
    folder = workspace / "doubling"
    old_readme = (folder / "README.md").read_bytes()
    before = files_in(workspace)
    dry = course("update --dry-run --json").json
    assert files_in(workspace) == before
    body = course("update --json").json
    for reply in (body, dry):
        assert [change["action"] for change in reply["changes"]] == ["replace", "beside"]
    assert (body["to_version"], dry["dry_run"]) == ("9.0.0", True)
    assert (folder / "README.md").read_text().endswith("# newer\n")
    assert (workspace / body["changes"][0]["backup"]).read_bytes() == old_readme
    assert (folder / "doubling.py").read_bytes() == mine
    assert Path(body["changes"][1]["new"]) == folder / "doubling.py.new"
    assert (folder / "doubling.py.new").read_text().endswith("# newer\n")
    assert 'version = "9.0.0"' in (workspace / "course.toml").read_text()
    done = files_in(folder)
    assert "up to date with the installed course" in course("update").out
    assert files_in(folder) == done


def test_update_keeps_an_earlier_new_file(course, workspace, write, newer_content):
    write("mine")
    beside = workspace / "doubling" / "doubling.py.new"
    beside.write_text("my notes")
    body = course("update --json").json
    assert (workspace / body["changes"][1]["backup"]).read_text() == "my notes"


def test_a_workspace_of_a_newer_course_is_not_taken_back_to_an_older_one(course, workspace):
    marker = workspace / "course.toml"
    marker.write_text(re.sub(r'^version = ".*"', 'version = "99.10.0"', marker.read_text(), flags=re.M))
    before = files_in(workspace)
    assert course("update --json").json["error"]["code"] == "workspace_newer"
    assert files_in(workspace) == before
    assert "this workspace at 99.10.0: install the newer course." in course().lacks("course update").words


def test_update_leaves_a_removed_file_removed(course, workspace, newer_content):
    (workspace / "doubling" / "doubling.py").unlink()
    assert course("update --json").json["changes"][1]["action"] == "missing"
    assert not (workspace / "doubling" / "doubling.py").exists()


def test_the_dashboard_outside_of_a_workspace_says_how_to_begin(course):
    course().ends(0, "course init")


def test_the_dashboard_survives_a_damaged_record(course, workspace):
    (workspace / ".course" / "progress.sqlite").write_bytes(b"not a database, not at all, no" * 10)
    course().ends(0, "Next: course doctor").warns("progress.sqlite")


def test_init_changes_nothing_in_a_workspace_where_a_file_is_or_where_course_toml_is_damaged(
    course, workspace
):
    before = files_in(workspace)
    assert course("init inner --json").error == (2, "nested_workspace")
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
    assert course("init --json").json["error"]["code"] == "other_course"
    marker.write_text("[[[")
    course("init").refuses(2, "course.toml:1")
    assert (workspace / "course.toml").read_text() == "[[["


@pytest.mark.skipif(os.name == "nt", reason="names and quotes of another system")
@pytest.mark.parametrize("name", ["plain", 'ws "x" $HOME', "-dash", "it's"])
def test_the_way_into_a_new_workspace_can_be_pasted(course, tmp_path, name):
    said = course("init --", name).out
    (line,) = re.findall("^Go there: (.+)$", said, re.MULTILINE)
    script = f"{line} && pwd"
    ran = subprocess.run(["sh", "-c", script], cwd=tmp_path, capture_output=True, text=True, check=True)
    assert ran.stdout == f"{tmp_path / name}\n"


def test_start_and_init_never_overwrite_and_start_brings_back_what_was_removed(course, workspace, write):
    path = write("mine")
    before = files_in(workspace)
    course("init").ends(0, "already")
    assert files_in(workspace) == before
    course("start doubling").ends(0, "was not changed")
    assert path.read_bytes() == before[path]
    path.unlink()
    assert course("start doubling/").code == 0
    assert path.is_file()


@pytest.mark.parametrize(
    "command", ["start doubling", "go", "check", "hint", "diff", "submit", "progress", "watch", "update"]
)
def test_outside_of_a_workspace_a_command_says_how_to_make_one(course, command):
    course(*command.split()).refuses(5, "course init")
