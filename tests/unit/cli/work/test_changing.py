"""The stub and newer versions of it; nothing is lost on the way."""

from __future__ import annotations

import pytest

from tests.unit.cli.conftest import files_in


def test_diff_shows_lines_added_and_removed_or_says_that_there_are_none(course, write, workspace):
    ran = course("diff")
    assert ran.code == 0
    assert "as it was handed out" in ran.out
    write("RIGHT", "wrong")
    body = course("diff", "--json").json
    assert body["changed"]
    assert "+    'RIGHT'" in body["diff"]
    assert body["added"] == sum(row.startswith("+") for row in body["diff"].splitlines()[2:])


def test_one_line_is_counted_as_one(course, workspace):
    path = workspace / "doubling" / "doubling.py"
    path.write_text(path.read_text() + "# one more\n")
    assert "1 line added, 0 removed." in course("diff").out


def test_reset_asks_nobody_but_needs_yes_and_keeps_a_copy_whose_path_it_prints(course, workspace, write):
    path = write("mine")
    before = path.read_bytes()
    ran = course("reset", "doubling", "--json")
    assert (ran.code, ran.json["error"]["code"]) == (2, "needs_yes")
    assert path.read_bytes() == before
    body = course("reset", "doubling", "--yes", "--json").json
    copy = workspace / body["backups"][0]["backup"]
    assert copy.read_bytes() == before
    assert "NotImplementedError" in path.read_text()
    assert "nothing was changed" in course("reset", "doubling").out


def test_reset_of_an_exercise_that_was_not_started_makes_nothing_of_it(course, workspace):
    before = files_in(workspace)
    ran = course("reset", "halving", "--yes", "--json")
    assert (ran.code, ran.json["error"]["code"]) == (5, "not_started")
    assert "course start halving" in ran.json["error"]["help"]
    assert files_in(workspace) == before


def test_reset_writes_nothing_if_the_copy_cannot_be_made(course, workspace, write):
    path = write("mine")
    before = path.read_bytes()
    (workspace / ".course" / "backups").write_text("a file where a folder should be")
    ran = course("reset", "doubling", "--yes")
    assert ran.code == 4
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
    dry = course("update", "--dry-run", "--json").json
    assert files_in(workspace) == before
    body = course("update", "--json").json
    assert (
        [c["action"] for c in body["changes"]]
        == [c["action"] for c in dry["changes"]]
        == ["replace", "beside"]
    )
    assert (body["to_version"], dry["dry_run"]) == ("9.0.0", True)
    assert (folder / "README.md").read_text().endswith("# newer\n")
    assert (workspace / body["changes"][0]["backup"]).read_bytes() == old_readme
    assert (folder / "doubling.py").read_bytes() == mine
    assert (folder / "doubling.py.new").read_text().endswith("# newer\n")
    assert 'version = "9.0.0"' in (workspace / "course.toml").read_text()
    done = files_in(folder)
    assert "up to date with the installed course" in course("update").out
    assert files_in(folder) == done


def test_update_keeps_an_earlier_new_file(course, workspace, write, newer_content):
    write("mine")
    beside = workspace / "doubling" / "doubling.py.new"
    beside.write_text("my notes")
    body = course("update", "--json").json
    assert (workspace / body["changes"][1]["backup"]).read_text() == "my notes"


def test_update_leaves_a_removed_file_removed(course, workspace, newer_content):
    (workspace / "doubling" / "doubling.py").unlink()
    assert course("update", "--json").json["changes"][1]["action"] == "missing"
    assert not (workspace / "doubling" / "doubling.py").exists()
