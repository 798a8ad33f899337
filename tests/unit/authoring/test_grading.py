"""Variants of a model solution are graded by the checks that can tell them from it, and to the same end."""

from __future__ import annotations

from typing import TYPE_CHECKING

import msgspec

from course.authoring.exercises.grading import grade_sources
from course.authoring.exercises.variants import accepted_files, compose, mutant_files, solution_path
from course.catalog.load import Catalog
from course.scoring.judging.session import GradingSession, Submission

if TYPE_CHECKING:
    from pathlib import Path

    import pytest

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


def test_every_source_gets_the_verdict_of_all_checks(mini: Path) -> None:
    catalog = Catalog()
    exercise = catalog.exercise("doubling")
    model = solution_path(catalog, exercise)
    sources = [compose(model, path) for path in accepted_files(catalog, exercise)]
    sources += [compose(model, path) for path in mutant_files(catalog, exercise)]
    sources += [f"{model.read_text('utf-8').rstrip()}\n\n\n{after}".encode() for after in AFTER.values()]
    sources += [exercise.stub_path.read_bytes(), b"def double(x):\n    return 2 * x\n", b"(", b""]
    found = dict(grade_sources([(exercise, source) for source in sources]))
    with GradingSession(exercise, catalog, scope="full") as session:
        for index, source in enumerate(sources):
            whole = session.grade(Submission({exercise.module: source}))
            assert plain(found[index]) == plain(whole), source.decode()[-80:]


def test_a_check_that_cannot_see_a_change_is_not_run_again(
    mini: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from course.authoring.exercises import grading

    asked: dict[str, set[str] | None] = {}
    grade_all = grading.grade_all

    def watched(entries, *rest, **named):
        entries = list(entries)
        for name, entry in zip(AFTER, entries, strict=True):
            asked[name] = {check.split("_")[0] for check in entry.only} or None
        return grade_all(entries, *rest, **named)

    monkeypatch.setattr(grading, "grade_all", watched)
    catalog = Catalog()
    exercise = catalog.exercise("doubling")
    model = solution_path(catalog, exercise).read_text("utf-8").rstrip()
    list(grade_sources([(exercise, f"{model}\n\n\n{after}".encode()) for after in AFTER.values()]))
    assert asked["a function"] == {"double"}
    assert asked["the other, by a helper"] == {"doublings"}
    assert asked["a module they both use"] == {"doublings"}
    for name in ("nothing", "something inside a function", "an item of a table", "what does not load"):
        assert asked[name] is None, name
