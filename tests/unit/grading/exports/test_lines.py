"""The plain exports: nothing in a cell is a formula, nothing is lost in quoting."""

from __future__ import annotations

import csv
import io
import json
from pathlib import Path

import msgspec
from hypothesis import given
from hypothesis import strategies as st

from course.grading.exports.grades import safe_cell, write_csv, write_jsonl
from course.grading.results.effective import Results
from tests.unit.grading.made import REFUSED, RIGHT, make_book


@given(st.text(alphabet=st.characters(exclude_categories=["Cs"])))
def test_no_text_becomes_a_formula_or_moves_the_cursor(text: str) -> None:
    cell = safe_cell(text)
    assert not cell.startswith(("=", "+", "-", "@"))
    assert cell.isprintable()


def test_the_reason_of_an_ungradable_one_is_in_its_row(tmp_path: Path) -> None:
    with make_book(tmp_path, {"ada": REFUSED}) as book:
        write_csv(tmp_path / "grades.csv", Results(book))
    (row,) = csv.DictReader(io.StringIO((tmp_path / "grades.csv").read_text("utf-8-sig"), newline=""))
    assert (row["state"], row["reason"], row["score"], row["passed"]) == ("ungradable", "no_file", "0", "no")


def test_a_line_of_json_has_every_field_of_the_contract(tmp_path: Path) -> None:
    with make_book(tmp_path, {"ada": RIGHT, "bob": REFUSED}) as book:
        results = Results(book)
        write_jsonl(tmp_path / "results.jsonl", results.all(), results.course)
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
    assert lines[0]["course"] == {"id": "mini", "version": "1"}
    assert lines[1]["error"] == {"code": "no_file", "message": "There is none.", "help": "Hand one in."}
    assert set(msgspec.structs.asdict(RIGHT.checks[0])) <= lines[0]["checks"][0].keys() | {"stdout"}
