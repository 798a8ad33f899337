"""A fault in the files of one exercise is that exercise's: named, without a score; the others are graded."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from course.catalog.load import Catalog
from course.grading.gradebook.book import Gradebook
from course.grading.running.run import RunOptions, grade_class
from course.scoring.judging.submission import Terms
from course.scoring.verdict import Verdict
from tests.unit.grading.conftest import MINI


@pytest.fixture
def course(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A copy of the miniature course, and a class of two whose work for both exercises is right."""
    shutil.copytree(MINI, tmp_path / "content")
    monkeypatch.setenv("COURSE_CONTENT", str(tmp_path / "content"))
    for student in ("ada", "bob"):
        for exercise in ("doubling", "halving"):
            (tmp_path / "class" / student / exercise).mkdir(parents=True)
            model = tmp_path / "content" / "solutions" / exercise / f"{exercise}.py"
            shutil.copy(model, tmp_path / "class" / student / exercise)
    return tmp_path / "content"


def graded(course: Path) -> tuple[Any, dict[tuple[str, str], Verdict]]:
    folder, out = course.parent / "class", course.parent / "out"
    options = RunOptions(terms=Terms(level="L1"), seed=1)
    summary = grade_class(folder, out, Catalog(), options, lambda *_: None)
    with Gradebook(out / "gradebook.sqlite") as book:
        return summary, {(one.key.student, one.key.exercise): one.verdict for one in book.results()}


def before_its_checks(text: str) -> Callable[[Path], None]:
    def spoil(course: Path) -> None:
        checks = course / "graders" / "halving" / "checks.py"
        checks.write_text(f"{text}\n{checks.read_text('utf-8')}", "utf-8")

    return spoil


def without(name: str) -> Callable[[Path], None]:
    return lambda course: (course / name).unlink()


#: What breaks an exercise, and what is said of it: the file at fault, its line, and the reason.
FAULTS: dict[str, tuple[Callable[[Path], None], str]] = {
    "a module that is not there": (
        before_its_checks("import no_such_module"),
        "graders/halving/checks.py:1: it cannot be imported (ModuleNotFoundError: No module named 'no_such_",
    ),
    "an exception": (
        before_its_checks("1 / 0"),
        "graders/halving/checks.py:1: it cannot be imported (ZeroDivisionError: division by zero).",
    ),
    "a syntax error": (
        before_its_checks("def (:"),
        "graders/halving/checks.py:1: it cannot be imported (SyntaxError: ",
    ),
    "an exit": (
        before_its_checks("raise SystemExit"),
        "graders/halving/checks.py:1: it cannot be imported (SystemExit).",
    ),
    "a file that graders do not have": (
        before_its_checks("open(__file__[:-9] + '../../solutions/halving/accepted/by_hand.py')"),
        "graders/halving/checks.py:1: it cannot be imported (FileNotFoundError: solutions/halving/accepted/",
    ),
    "a name that no check has": (
        before_its_checks("from course.scoring import nothing_of_this_name"),
        "graders/halving/checks.py:1: it cannot be imported (ImportError: cannot import name 'nothing_of_th",
    ),
    "no hidden checks": (
        without("graders/halving/checks.py"),
        "graders/halving/checks.py: it is missing, and halving has ",
    ),
    "a check without its marks": (
        before_its_checks("def test_unmarked(submission):\n    'It has no points'\n"),
        "graders/halving/checks.py:1: check test_unmarked: it lacks a mark",
    ),
}


@pytest.mark.turns(4)
@pytest.mark.parametrize("fault", FAULTS)
def test_the_fault_of_one_exercise_is_named_and_costs_no_other(course: Path, fault: str) -> None:
    spoil, said = FAULTS[fault]
    spoil(course)
    summary, verdicts = graded(course)
    assert [verdicts[student, "doubling"].state for student in ("ada", "bob")] == ["graded"] * 2
    assert [verdicts[student, "doubling"].passed for student in ("ada", "bob")] == [True] * 2
    for student in ("ada", "bob"):
        verdict = verdicts[student, "halving"]
        assert (verdict.state, verdict.error and verdict.error.code) == ("grader_error", "check_file")
        assert verdict.error is not None
        assert verdict.error.message.startswith(said)
        assert str(course) not in verdict.error.message
    assert summary.exit_code == 70
