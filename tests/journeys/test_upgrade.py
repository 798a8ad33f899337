"""Work of a student and of an instructor that 1.2.0 made, opened, changed and graded again by this version.

The files are 1.2.0's own: a workspace with a lesson read, two exercises in work, a notebook, a hint, an
attempt at the quiz and a submission; a class with a late policy, times and an override; a class with a quiz.
"""

import csv
import io
import json
import shutil
import sqlite3
from contextlib import closing
from pathlib import Path

import pytest

from course import __version__
from course.progress.store import Store

MADE = Path(__file__).resolve().parents[1] / "fixtures" / "made_by_1_2_0"


def _known(found):
    """What 1.2.0 said of the same record, in its words."""
    told = json.loads((MADE / "progress.json").read_text("utf-8"))
    same = {name: found[name] for name in ("quiz", "submissions")}
    for name in ("lessons", "exercises"):
        now = {one["id"]: one for one in found[name]}
        same[name] = [{key: now[one["id"]][key] for key in one} for one in told[name]]
    return same


def test_a_workspace_of_1_2_0_says_and_keeps_what_it_said_then(student, tmp_path):
    workspace = shutil.copytree(MADE / "workspace", tmp_path / "workspace")
    told = json.loads((MADE / "progress.json").read_text("utf-8"))
    assert _known(json.loads(student("progress", "--json", cwd=workspace).stdout)) == told
    before = {path: path.read_bytes() for path in workspace.rglob("*") if path.is_file()}
    student("update", cwd=workspace)
    typed = [workspace / name / f"{name}.py" for name in ("integrators", "collisions")]
    assert [path.read_bytes() for path in typed] == [before[path] for path in typed]
    kept = {path.read_bytes() for path in (workspace / ".course").rglob("*") if path.is_file()}
    changed = [
        path for path, data in before.items() if ".course" not in path.parts and path.read_bytes() != data
    ]
    settings = workspace / "course.toml"
    assert all(before[path] in kept for path in changed if path != settings), changed
    # Of the student's settings only the version is another one.
    version = settings.read_bytes().replace(f'version = "{__version__}"'.encode(), b'version = "1.2.0"')
    assert version == before[settings]
    student("check", "integrators", cwd=workspace)
    student("quiz", "history", cwd=workspace)
    student("submit", cwd=workspace, stdin="y\n")
    after = _known(json.loads(student("progress", "--json", cwd=workspace).stdout))
    assert after["quiz"] == told["quiz"]
    assert (after["lessons"], len(after["submissions"])) == (told["lessons"], 2)


def test_who_read_how_contact_is_solved_in_1_2_0_has_read_both_lessons_that_came_of_it(student, tmp_path):
    workspace = shutil.copytree(MADE / "workspace", tmp_path / "workspace")
    before = json.loads(student("progress", "--json", cwd=workspace).stdout)
    Store(workspace / ".course" / "progress.sqlite").append(
        "lesson", "how-contact-is-solved", {"version": "1.2.0"}
    )
    after = json.loads(student("progress", "--json", cwd=workspace).stdout)
    read = {one["id"] for one in after["lessons"] if one["read_at"]}
    read -= {one["id"] for one in before["lessons"] if one["read_at"]}
    assert read == {"how-contact-is-solved", "what-contact-leaves-over"}


def _rows(gradebook):
    with closing(sqlite3.connect(f"file:{gradebook}?mode=ro&immutable=1", uri=True)) as connection:
        return list(connection.iterdump())


@pytest.mark.parametrize(
    ("name", "student_id", "exercise"), [("late", "cem", "collisions"), ("quiz", "ada", "validation")]
)
def test_a_gradebook_of_1_2_0_gives_its_grades_and_is_upgraded_once(
    instructor, tmp_path, name, student_id, exercise
):
    out = tmp_path / "grades"
    out.mkdir()
    shutil.copy(MADE / f"{name}.sqlite", out / "gradebook.sqlite")
    old, told = (out / "gradebook.sqlite").read_bytes(), (MADE / f"{name}.csv").read_text("utf-8-sig")

    def grades():
        return instructor("grade", "export", out, "--format", "csv", "-o", "-").stdout.removeprefix("\ufeff")

    assert grades() == told
    assert (out / "gradebook.sqlite").read_bytes() == old, "to read is not to change"
    for score in (5, 6):
        instructor("grade", "override", out, student_id, exercise, "--score", score, "--reason", "talked")
    (copy,) = out.glob("gradebook.format-*.sqlite")
    assert _rows(copy) == _rows(MADE / f"{name}.sqlite")
    changed = list(csv.DictReader(io.StringIO(grades())))
    for one, before in zip(changed, csv.DictReader(io.StringIO(told)), strict=True):
        mine = (one["student"], one["exercise"]) == (student_id, exercise)
        assert one == (
            {**before, "score": "6", "passed": "no", "override_reason": "talked"} if mine else before
        )
    instructor("grade", "log", out)
    instructor("grade", "explain", out, student_id, exercise)
