"""Variants of a model solution are graded by the checks that can tell them from it, and to the same end."""

from __future__ import annotations

from typing import TYPE_CHECKING
from unittest.mock import Mock

import msgspec
import pytest

from course.authoring.exercises import grading
from course.authoring.exercises.grading import grade_sources
from course.authoring.exercises.variants import accepted_files, compose, mutant_files, solution_path
from course.catalog.load import Catalog
from course.scoring.judging.session import GradingSession, Submission

if TYPE_CHECKING:
    from pathlib import Path

    from course.scoring.verdict import Verdict

#: What may come after a model solution, and the checks of "doubling" that see it.
AFTER = {
    "nothing": "",
    "a function": "def double(x):\n    return x + 1.0\n",
    "the other, by a helper": "def _two():\n    return 3.0\ndef doublings(x, n):\n    return x * _two()\n",
    "a name that nothing uses": "UNUSED = 1\n",
    "a module they both use": "import math as np\n",
    "something inside a function": "double.__code__ = (lambda x: x).__code__\n",
    "an item of a table": "TABLE = {}\nTABLE['a'] = 1\n",
    "what does not load": "raise ValueError\n",
}


def plain(verdict: Verdict) -> Verdict:
    """A verdict without what differs from run to run."""
    checks = tuple(msgspec.structs.replace(check, duration_ms=0.0) for check in verdict.checks)
    return msgspec.structs.replace(verdict, checks=checks)


@pytest.mark.parametrize("worth_a_grader", [5, 100], ids=["processes", "here"])
def test_every_source_gets_the_verdict_of_all_checks(
    mini: Path, monkeypatch: pytest.MonkeyPatch, worth_a_grader: int
) -> None:
    monkeypatch.setattr(grading, "_WORTH_A_GRADER", worth_a_grader)
    monkeypatch.setattr(grading, "grade_all", used := Mock(wraps=grading.grade_all))
    catalog = Catalog()
    exercise = catalog.exercise("doubling")
    model = solution_path(catalog, exercise)
    sources = [compose(model, path) for path in accepted_files(catalog, exercise)]
    sources += [compose(model, path) for path in mutant_files(catalog, exercise)]
    sources += [f"{model.read_text('utf-8').rstrip()}\n\n\n{after}".encode() for after in AFTER.values()]
    sources += [exercise.stub_path.read_bytes(), b"def double(x):\n    return 2 * x\n", b"(", b""]
    found = dict(grade_sources([(exercise, source) for source in sources]))
    assert used.called == (worth_a_grader == 5)
    with GradingSession(exercise, catalog, scope="full") as session:
        for index, source in enumerate(sources):
            whole = session.grade(Submission({exercise.module: source}))
            assert plain(found[index]) == plain(whole), source.decode()[-80:]


def test_a_check_that_cannot_see_a_change_is_not_run_again(
    mini: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[set[str] | None] = []
    grade = GradingSession.grade

    def watched(session, submission, *, only=()):
        asked.append({check.split("_")[0] for check in only} or None)
        return grade(session, submission, only=only)

    monkeypatch.setattr(GradingSession, "grade", watched)
    catalog = Catalog()
    exercise = catalog.exercise("doubling")
    model = solution_path(catalog, exercise).read_text("utf-8").rstrip()
    list(grade_sources([(exercise, f"{model}\n\n\n{after}".encode()) for after in AFTER.values()]))
    of = dict(zip(["the model", *AFTER], asked, strict=True))
    assert of["a function"] == {"double"}
    assert of["the other, by a helper"] == {"doublings"}
    assert of["a module they both use"] == {"doublings"}
    for name in ("nothing", "something inside a function", "an item of a table", "what does not load"):
        assert of[name] is None, name
