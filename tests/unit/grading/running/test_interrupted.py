"""A run that is interrupted: what it had not looked at is not graded yet, and nothing says anything else."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator
from pathlib import Path

import pytest

from course.catalog.load import Catalog
from course.errors import MissingCapabilityError
from course.grading.exports.formats import export
from course.grading.exports.selection import ExportOptions
from course.grading.intake.students import Entry
from course.grading.results.roster import read_roster
from course.grading.running.batch import Graded
from course.grading.running.folder import export_all, open_results
from course.grading.running.run import RunOptions
from course.scoring.judging.submission import Terms
from tests.command_line import in_process
from tests.unit.grading.made import graded_class
from tests.unit.grading.running.test_run import make_class, right

pytestmark = pytest.mark.usefixtures("unpacked")
#: Sentences about somebody who handed in, of which none may be said of a student who waits.
UNTRUE = ("handed in nothing", "Nothing was handed in", "nothing was handed in", "not_submitted", "missing")


def interrupted_after(count: int):
    """A grader that is interrupted when it has graded so many."""

    def grade(entries: Iterable[Entry], terms: Terms) -> Iterator[Graded]:
        for number, graded in enumerate(right(entries, terms)):
            if number == count:
                raise KeyboardInterrupt
            yield graded

    return grade


@pytest.fixture
def stopped(tmp_path: Path, catalog: Catalog, solution: bytes) -> Path:
    """The folder of a run that was interrupted after two of five, with a roster of six."""
    make_class(tmp_path / "class", solution, 5)
    names = [f"student-00{number}" for number in range(5)]
    rows = "".join(f"{name},{number},{number}\n" for number, name in enumerate([*names, "absent"]))
    (tmp_path / "roster.csv").write_text(f"student,canvas_id,moodle_key\n{rows}", "utf-8")
    options = RunOptions(seed=3, roster=read_roster(tmp_path / "roster.csv"))
    with pytest.raises(KeyboardInterrupt):
        graded_class(tmp_path, catalog, options, grade=interrupted_after(2))
    return tmp_path / "out"


def states(out: Path) -> dict[tuple[str, str], str]:
    with open_results(out) as results:
        return {(item.student, item.exercise): item.verdict.state for item in results.all()}


def test_who_was_not_reached_is_not_graded_yet_and_no_platform_is_told_anything(
    stopped: Path, tmp_path: Path
) -> None:
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


def test_every_page_table_and_command_says_so(stopped: Path) -> None:
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
    assert "not graded yet: the run was interrupted" in pages["report.html"]
    assert "student-003 / " not in (stopped / "junit.xml").read_text("utf-8")


def test_resuming_grades_them_and_the_log_holds_nothing_of_it(
    stopped: Path, tmp_path: Path, catalog: Catalog
) -> None:
    options = RunOptions(resume=True)
    summary = graded_class(tmp_path, catalog, options, grade=right)
    assert (summary.already, summary.states["graded"]) == (2, 5)
    with open_results(stopped) as results:
        assert results.waiting == set()
        assert results.book.journal() == []
        assert {item.verdict.state for item in results.all()} == {"graded", "missing"}


def test_a_resumed_run_that_is_interrupted_takes_back_what_the_files_said(
    tmp_path: Path, catalog: Catalog, solution: bytes
) -> None:
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
