"""Gradebooks made by hand, for tests of what is made from them; PHP's CSV; graders that die young."""

import csv
import importlib.util
import io
import json
import re
import subprocess
import zipfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import pytest

from course.catalog.load import Catalog
from course.catalog.models import Exercise
from course.grading.gradebook.book import Gradebook
from course.grading.gradebook.records import GradedExercise, Key, Result
from course.grading.intake.downloads import class_list
from course.grading.intake.students import Entry, read_student
from course.grading.results.roster import Roster, read_roster
from course.grading.running.grader import Config
from course.grading.running.run import RunOptions, Summary, grade_class
from course.scoring.judging.submission import Submission
from course.scoring.verdict import CheckResult, Problem, Status, Tolerance, Verdict, Visibility

SECRET = 1234.5678
HAS_CLUSTER = all(importlib.util.find_spec(name) for name in ("distributed", "cryptography"))
NEEDS_CLUSTER = pytest.mark.skipif(
    not HAS_CLUSTER, reason="needs the extra `cluster`: distributed and cryptography are not installed"
)

#: Names of students as nobody should have them, and some do.
HOSTILE = [
    "=cmd|' /C calc'!A0", "+1", "-1", "@x", "\tx", "\r\nx", 'a"b', "a,b", "a;b", "a\nb", "é漢字",
    "\x1b[31mred", "'=1+1", "=1+1", "<script>alert(1)</script>", "]]>&amp;", "../../up", "Ada\u202eevoL",
    "\u00a0", "\uff1d1", "O'Neil", "a\x00b", "\ufffe\uffff", "x" * 300,
    'a\\"b', "a\\", "\U0001f680 Ada", "\U0001f469\u200d\U0001f680", "\u05d0\u05d3\u05d4",
]  # fmt: skip


def zipped(members: Mapping[str, bytes | str]) -> bytes:
    """An archive, with the very names."""
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as archive:
        for name, content in members.items():
            archive.writestr(zipfile.ZipInfo(name), content)
    return buffer.getvalue()


def put(path: Path, content: bytes) -> None:
    """A file, and the folders above it."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(content)


def read_csv(path: Path) -> list[dict[str, str]]:
    return list(csv.DictReader(io.StringIO(path.read_text("utf-8-sig"), newline=""), strict=True))


def roster_of(folder: Path, text: str) -> Roster:
    """A roster, in a file of the folder."""
    path = folder / "roster.csv"
    path.write_bytes(text.encode("utf-8"))
    return read_roster(path)


def notebook(*cells: str) -> bytes:
    """One of code cells."""
    made = [{"cell_type": "code", "source": cell, "metadata": {}, "outputs": []} for cell in cells]
    return json.dumps({"nbformat": 4, "nbformat_minor": 5, "metadata": {}, "cells": made}).encode()


def read_class(folder: Path, exercises: Sequence[Exercise], *, required: bool) -> Iterator[Entry]:
    """Every student's entries, in order of name."""
    for student in class_list(folder).students:
        yield from read_student(student, exercises, required=required)


def graded_class(
    folder: Path,
    catalog: Catalog,
    options: RunOptions,
    report: Callable[..., None] = lambda *_: None,
    **more: Any,
) -> Summary:
    """Grade ``class`` in a folder, into ``out`` in it."""
    return grade_class(folder / "class", folder / "out", catalog, options, report, **more)


def digest(student: str) -> str:
    """Of what ``make_book`` has a student hand in."""
    return Submission({"doubling.py": student.encode()}).sha256


def key(student: str, exercise: str = "doubling", version: str = "v1") -> Key:
    return Key(student, exercise, digest(student), version, 7)


def check(
    name: str, status: Status = Status.PASS, *, hidden: bool = False, points: float = 5.0
) -> CheckResult:
    right = status is Status.PASS
    return CheckResult(
        id=name,
        title=f"The title of {name}",
        task="double",
        status=status,
        visibility=Visibility.HIDDEN if hidden else Visibility.PUBLIC,
        points=points if right else 0.0,
        max_points=points,
        input=None if right else {"x": SECRET},
        expected=None if right else SECRET * 2,
        actual=None if right else "<b>1</b>",
        units="m",
        tolerance=None if right else Tolerance(rel=1e-3, source="exact"),
        diagnosis=None if right else "SQUARES",
        message="" if right else "It is not twice the number.",
        help="" if right else "Add it to itself.",
        stdout=None if right else f"I saw {SECRET}",
        duration_ms=1.5,
    )


def verdict(
    *checks: CheckResult, state: str = "graded", exercise: str = "doubling", error: Problem | None = None
) -> Verdict:
    score = sum(item.points for item in checks)
    return Verdict(
        exercise=exercise,
        scope="full",
        state=state,
        score=score,
        max_score=10.0,
        passed=state == "graded" and score >= 7,
        checks=checks,
        isolation="L3" if state == "graded" else "",
        error=error or (None if state == "graded" else Problem("no_file", "There is none.", "Hand one in.")),
    )


RIGHT = verdict(check("shown"), check("kept_back", hidden=True))
HALF = verdict(check("shown"), check("kept_back", Status.FAIL, hidden=True))
WRONG = verdict(check("shown", Status.FAIL), check("kept_back", Status.FAIL, hidden=True))
REFUSED = verdict(state="ungradable")
BROKEN = verdict(
    check("shown", Status.GRADER_ERROR),
    state="grader_error",
    error=Problem("check_failed", f"kept_back: ZeroDivisionError at {SECRET}", "Regrade."),
)


def make_book(path: Path, verdicts: dict[str, Verdict]) -> Gradebook:
    """An open gradebook with one result per student."""
    path.mkdir(parents=True, exist_ok=True)
    book = Gradebook(path / "gradebook.sqlite", create=True, writing=True)
    book.set_meta(seed="7", course="mini", version="1")
    book.begin_run("run", {"timeout": 10.0})
    book.set_exercises(
        [
            GradedExercise("doubling", "Doubling", 10.0, 0.7, 1),
            GradedExercise("halving", "Halving", 2.0, 0.7, 2),
        ]
    )
    for student, found in verdicts.items():
        book.add(Result(key(student), found), {"doubling.py": student.encode()})
    return book


#: A cell: what is in quotes, where a backslash keeps the next sign, a quote too; what follows them; its end.
_PHP_CELL = re.compile(r'(?:"((?:\\.|""|[^"\\])*)"?)?([^,\n]*)([,\n])', re.DOTALL)


def read_by_php(text: str) -> list[list[str]]:
    """Rows of a CSV file as PHP gives them with a backslash as its escape, which is how Moodle calls it.

    Source: moodle/lib/csvlib.class.php, ``load_csv_content``; php-src/ext/standard/file.c, ``php_fgetcsv``.
    """
    rows: list[list[str]] = [[]]
    for quoted, plain, end in _PHP_CELL.findall(text.replace("\r\n", "\n") + "\n"):
        rows[-1].append(quoted.replace('""', '"') + plain)
        if end == "\n":
            rows.append([])
    return [row for row in rows if row not in ([], [""])]


def stillborn(
    start: Callable[[Config], subprocess.Popen[bytes]], deaths: int
) -> Callable[[Config], subprocess.Popen[bytes]]:
    """What starts a grader, except that so many of the first ones die before they are ready."""
    dying = iter(range(deaths))

    def start_or_die(config: Config) -> subprocess.Popen[bytes]:
        process = start(config)
        if next(dying, None) is not None:
            process.kill()
            process.wait()
        return process

    return start_or_die
