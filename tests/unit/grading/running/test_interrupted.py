"""A run that is interrupted: what it had not looked at is not graded yet, and nothing says anything else."""

import contextlib
import json
import shutil
import sqlite3
from dataclasses import replace

import pytest

from course.errors import MissingCapabilityError
from course.grading.exports.formats import export
from course.grading.exports.selection import ExportOptions
from course.grading.gradebook.book import Gradebook
from course.grading.gradebook.salvage import backups, salvage
from course.grading.running.folder import export_all, open_results, remember
from course.grading.running.run import RunOptions, grade_class
from tests.command_line import in_process
from tests.unit.grading.made import graded_class, roster_of
from tests.unit.grading.running.test_run import make_class, right

pytestmark = pytest.mark.usefixtures("unpacked")
#: Sentences about somebody who handed in, of which none may be said of a student who waits.
UNTRUE = ("handed in nothing", "Nothing was handed in", "nothing was handed in", "not_submitted", "missing")


def interrupted_after(count):
    """A grader that is interrupted when it has graded so many."""

    def grade(entries, terms):
        for number, graded in enumerate(right(entries, terms)):
            if number == count:
                raise KeyboardInterrupt
            yield graded

    return grade


@pytest.fixture
def stopped(tmp_path, catalog, solution):
    """The folder of a run that was interrupted after two of five, with a roster of six."""
    make_class(tmp_path / "class", solution, 5)
    names = [f"student-00{number}" for number in range(5)]
    rows = "".join(f"{name},{number},{number}\n" for number, name in enumerate([*names, "absent"]))
    options = RunOptions(seed=3, roster=roster_of(tmp_path, f"student,canvas_id,moodle_key\n{rows}"))
    with pytest.raises(KeyboardInterrupt):
        graded_class(tmp_path, catalog, options, grade=interrupted_after(2))
    return tmp_path / "out"


def states(out):
    with open_results(out) as results:
        return {(item.student, item.exercise): item.verdict.state for item in results.all()}


def test_who_was_not_reached_is_not_graded_yet_and_no_platform_is_told_anything(stopped, tmp_path):
    found = states(stopped)
    assert [found[f"student-00{number}", "doubling"] for number in range(2)] == ["graded"] * 2
    waiting = {student for (student, _), state in found.items() if state == "not_graded_yet"}
    assert waiting >= {"student-002", "student-003", "student-004"}
    # Enrolled, and without a folder: that is known.
    assert found["absent", "doubling"] == "missing"
    sheet = tmp_path / "sheet.csv"
    sheet.write_text("Identifier,Grade,Last modified (grade)\nParticipant 3,,-\n", "utf-8")
    options = ExportOptions(("doubling",), {"doubling": "4711"}, zeros=True, missing="zero", worksheet=sheet)
    with open_results(stopped) as results:
        for item in results.all():
            assert item.waiting == (item.verdict.state == "not_graded_yet")
            assert not (item.waiting and item.score is not None)
        for form in ("canvas", "moodle", "moodle-worksheet", "gradescope"):
            with pytest.raises(MissingCapabilityError) as refused:
                export(results, form, stopped, None, options)
            assert refused.value.code == "not_graded_yet"
            assert "student-002" in refused.value.message
    assert sorted(path.name for path in stopped.iterdir()) == ["gradebook.sqlite"]


def test_every_page_table_and_command_says_so(stopped):
    shown = in_process("grade", "explain", stopped, "student-003", "doubling").stdout
    assert "not_graded_yet" in shown
    assert "--resume" in shown
    listed = in_process("grade", "assign", stopped).stdout
    assert "Not graded yet: 3 students. The run goes on with --resume." in listed, "0 to settle is not all"
    said = shown + in_process("grade", "log", stopped).stdout
    assert not [words for words in UNTRUE if words in said]
    with open_results(stopped) as results:
        export_all(stopped, results)
        for form in ("csv", "jsonl", "junit"):
            export(results, form, stopped, None, ExportOptions())
    lines = [json.loads(line) for line in (stopped / "results.jsonl").read_text("utf-8").splitlines()]
    told = [line for line in lines if line["student"] == "student-003"]
    assert {(line["state"], line["score"]) for line in told} == {("not_graded_yet", None)}
    rows = (stopped / "grades.csv").read_text("utf-8").splitlines()
    assert all("not_graded_yet" in row for row in rows if "student-003" in row)
    pages = {path.name: path.read_text("utf-8") for path in stopped.rglob("*.html")}
    mine = [text for text in pages.values() if "<title>student-003" in text]
    assert len(mine) == 1
    assert "not graded yet" in mine[0]
    for page in mine:
        assert not [words for words in UNTRUE if words in page]
    assert "not graded yet: no run has looked at it" in pages["report.html"]
    assert "student-003 / " not in (stopped / "junit.xml").read_text("utf-8")


ADA, CY = ("student-000",), "student-002"
#: What was run before, of a class of three (the last came in between) -> who and what nobody looked at.
LEFT = {
    "a part": ([RunOptions(only=ADA)], {(name, "doubling") for name in (CY, "student-001", "absent")}),
    "a part, later": ([RunOptions(), RunOptions(only=ADA)], {(CY, "doubling")}),
    "another exercise": (
        [RunOptions(exercises=("doubling",)), RunOptions(exercises=("halving",))], {(CY, "doubling")}
    ),
    "a part of another": (
        [RunOptions(exercises=("doubling",)), RunOptions(exercises=("halving",), only=ADA)],
        {(CY, "doubling"), *((name, "halving") for name in (CY, "student-001", "absent"))},
    ),
}  # fmt: skip


def test_who_was_gone_before_anybody_looked_is_missing_once_all_are_looked_at(tmp_path, catalog, solution):
    roster = roster_of(tmp_path, f"student\nstudent-000\nstudent-001\n{CY}\n")
    make_class(tmp_path / "class", solution, 2)
    options = RunOptions(exercises=("doubling",), roster=roster)
    graded_class(tmp_path, catalog, options, grade=right)
    make_class(tmp_path / "class", solution, 3)
    graded_class(tmp_path, catalog, replace(options, only=ADA, resume=True), grade=right)
    assert states(tmp_path / "out")[CY, "doubling"] == "not_graded_yet"
    shutil.rmtree(tmp_path / "class" / CY)
    graded_class(tmp_path, catalog, replace(options, resume=True), grade=right)
    assert states(tmp_path / "out")[CY, "doubling"] == "missing"


@pytest.mark.parametrize("how", LEFT)
def test_of_work_that_no_run_looked_at_nothing_says_that_it_was_not_handed_in(
    tmp_path, catalog, solution, how
):
    """Whom --only left out, and what --exercise passed over, was missing, and 0 with --missing zero."""
    names = ["student-000", "student-001", CY, "absent"]
    rows = "\n".join(["student,canvas_id", *(f"{name},{number}" for number, name in enumerate(names))])
    runs, unread = LEFT[how]
    for number, options in enumerate(runs):
        if number == len(runs) - 1:
            make_class(tmp_path / "class", solution, 3)
            (tmp_path / "class" / ADA[0] / "halving.py").write_bytes(b"x")
        else:
            make_class(tmp_path / "class", solution, 2)
        mine = replace(options, resume=bool(number), seed=3, roster=roster_of(tmp_path, rows))
        summary = graded_class(tmp_path, catalog, mine, grade=right)
    found = states(tmp_path / "out")
    waiting = {about for about, state in found.items() if state == "not_graded_yet"}
    assert {about for about in waiting if about[1] == "doubling" or "part of" in how} == unread
    assert not {student for student, _ in unread} & set(summary.missing)
    asked = ExportOptions(("doubling", "halving"), {"doubling": "1", "halving": "2"}, missing="zero")
    with open_results(tmp_path / "out") as results, pytest.raises(MissingCapabilityError) as refused:
        export(results, "canvas", tmp_path, None, asked)
    assert refused.value.code == "not_graded_yet"
    everything = RunOptions(exercises=("doubling", "halving"), resume=True)
    graded_class(tmp_path, catalog, everything, grade=right)
    assert set(states(tmp_path / "out").values()) == {"graded", "missing"}
    with open_results(tmp_path / "out") as results:
        assert results.book.journal() == []


def test_after_a_loss_nothing_is_missing_until_a_run_has_looked(tmp_path, catalog, solution):
    make_class(tmp_path / "class", solution, 2)
    roster = roster_of(tmp_path, "student\nstudent-000\nstudent-001\nabsent\n")
    options = RunOptions(seed=3, roster=roster)
    graded_class(tmp_path, catalog, options, grade=right)
    path, new = tmp_path / "out" / "gradebook.sqlite", tmp_path / "new" / "gradebook.sqlite"
    for backup in backups(path):
        backup.unlink()
    with contextlib.closing(sqlite3.connect(path)) as db:
        for about in ("results WHERE student = 'student-001'", "meta WHERE key = 'roster'"):
            db.execute(f"DELETE FROM {about}")
        db.commit()
    new.parent.mkdir()
    lost = salvage(path, new).lost
    assert {"the roster", "the result of student-001 for doubling"} <= set(lost)
    again = replace(options, resume=True)
    with Gradebook(new, writing=True) as book:
        remember(book, again.roster)
    assert set(states(new.parent).values()) == {"graded", "not_graded_yet"}
    grade_class(tmp_path / "class", new.parent, catalog, again, lambda *_: None, grade=right)
    found = states(new.parent)
    assert (found["student-001", "doubling"], found["absent", "doubling"]) == ("graded", "missing")


def test_a_resumed_run_that_is_interrupted_takes_back_what_the_files_said(tmp_path, catalog, solution):
    """Somebody handed in after the first run, whose files say that there is nothing."""
    make_class(tmp_path / "class", solution, 2)
    (tmp_path / "class" / "zoe").mkdir()
    out = tmp_path / "out"
    graded_class(tmp_path, catalog, RunOptions(seed=3), grade=right)
    assert states(out)["zoe", "doubling"] == "missing"
    (tmp_path / "class" / "zoe" / "doubling.py").write_bytes(solution)
    with pytest.raises(KeyboardInterrupt):
        graded_class(tmp_path, catalog, RunOptions(resume=True), grade=interrupted_after(0))
    assert states(out)["zoe", "doubling"] == "not_graded_yet"
    rows = [line for line in (out / "grades.csv").read_text("utf-8").splitlines() if "zoe" in line]
    assert rows
    assert all("not_graded_yet" in row for row in rows)
    graded_class(tmp_path, catalog, RunOptions(resume=True), grade=right)
    assert states(out)["zoe", "doubling"] == "graded"
