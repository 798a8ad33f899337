"""The plain exports: nothing in a cell is a formula, nothing is lost in quoting."""

from __future__ import annotations

import csv
import io
import json
from typing import TYPE_CHECKING

import msgspec
from hypothesis import given
from hypothesis import strategies as st

from course.grading.exports.lines import CourseRef, safe_cell, write_csv, write_jsonl
from course.grading.gradebook import Key, Result
from course.grading.verdict import CheckResult, Problem, Status, Verdict, Visibility

if TYPE_CHECKING:
    from pathlib import Path

HOSTILE = ["=cmd|' /C calc'!A0", "+1", "-1", "@x", "\tx", "\r\nx", 'a"b', "a,b", "a\nb", "é漢", "\x1b[31mred"]


def result(student: str, error: Problem | None = None) -> Result:
    check = CheckResult(
        id="c",
        title="t",
        task="double",
        status=Status.PASS,
        visibility=Visibility.PUBLIC,
        points=1,
        max_points=1,
    )
    verdict = Verdict(
        exercise="doubling", scope="full", state="ungradable" if error else "graded", score=0 if error else 1,
        max_score=1, passed=not error, checks=() if error else (check,), isolation="L3", error=error,
    )  # fmt: skip
    return Result(Key(student, "doubling", "a" * 64, "v", 1), verdict)


def rows(path: Path) -> list[dict[str, str]]:
    return list(csv.DictReader(io.StringIO(path.read_text("utf-8-sig"), newline="")))


def test_hostile_names_are_rows_of_their_own_and_no_formulas(tmp_path: Path) -> None:
    write_csv(tmp_path / "grades.csv", [result(name) for name in HOSTILE])
    found = rows(tmp_path / "grades.csv")
    assert len(found) == len(HOSTILE)
    assert not any(row["student"].startswith(("=", "+", "-", "@", "\t", "\r")) for row in found)
    assert [row["student"] for row in found if "é" in row["student"]] == ["é漢"]
    assert "\x1b" not in (tmp_path / "grades.csv").read_text("utf-8")


@given(st.text(alphabet=st.characters(exclude_categories=["Cs"])))
def test_no_text_becomes_a_formula_or_moves_the_cursor(text: str) -> None:
    cell = safe_cell(text)
    assert not cell.startswith(("=", "+", "-", "@"))
    assert cell.isprintable()


def test_the_reason_of_an_ungradable_one_is_in_its_row(tmp_path: Path) -> None:
    write_csv(tmp_path / "grades.csv", [result("ada", Problem("no_file", "There is none."))])
    (row,) = rows(tmp_path / "grades.csv")
    assert (row["state"], row["reason"], row["score"], row["passed"]) == ("ungradable", "no_file", "0", "no")


def test_a_line_of_json_has_every_field_of_the_contract(tmp_path: Path) -> None:
    write_jsonl(
        tmp_path / "results.jsonl", [result("ada"), result("bob", Problem("x", "y"))], CourseRef("c", "1")
    )
    lines = [json.loads(line) for line in (tmp_path / "results.jsonl").read_bytes().splitlines()]
    contract = {
        "schema", "ok", "exit_code", "course", "exercise", "scope", "score", "max_score", "passed", "checks",
        "warnings", "student", "submission_sha256", "grader_version", "isolation", "state", "late",
    }  # fmt: skip
    assert all(contract <= line.keys() for line in lines)
    assert [line["schema"] for line in lines] == ["course.grade/1"] * 2
    assert [(line["state"], line["exit_code"], line["ok"]) for line in lines] == [
        ("graded", 0, True),
        ("ungradable", 3, False),
    ]
    assert lines[0]["course"] == {"id": "c", "version": "1"}
    assert lines[1]["error"] == {"code": "x", "message": "y", "help": ""}
    assert set(msgspec.structs.asdict(result("a").verdict.checks[0])) <= lines[0]["checks"][0].keys() | {
        "stdout"
    }
