"""A fault in the files of one exercise is that exercise's: named, without a score; the others are graded."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from course.catalog.load import Catalog
from course.grading.gradebook.book import Gradebook
from course.grading.running.run import RunOptions
from course.scoring.judging.submission import Terms
from tests.unit.grading.conftest import MINI
from tests.unit.grading.made import graded_class

#: What stands above an exercise's hidden checks, if there are any, and what is said of it: the file at fault,
#: its line, and the reason.
FAULTS: dict[str, tuple[str | None, str]] = {
    "a module that is not there": (
        "import no_such_module",
        "graders/{name}/checks.py:1: it cannot be imported (ModuleNotFoundError: No module named 'no_such_",
    ),
    "an exception": (
        "1 / 0",
        "graders/{name}/checks.py:1: it cannot be imported (ZeroDivisionError: division by zero).",
    ),
    "a syntax error": (
        "def (:",
        "graders/{name}/checks.py:1: it cannot be imported (SyntaxError: ",
    ),
    "an exit": (
        "raise SystemExit",
        "graders/{name}/checks.py:1: it cannot be imported (SystemExit).",
    ),
    "a file that graders do not have": (
        "open(__file__[:-9] + '../../solutions/halving/accepted/by_hand.py')",
        "graders/{name}/checks.py:1: it cannot be imported (FileNotFoundError: solutions/halving/accepted/",
    ),
    "a name that no check has": (
        "from course.scoring import nothing_of_this_name",
        "graders/{name}/checks.py:1: it cannot be imported (ImportError: cannot import name 'nothing_of_th",
    ),
    "no hidden checks": (
        None,
        "graders/{name}/checks.py: it is missing, and {name} has ",
    ),
    "a check without its marks": (
        "def test_unmarked(submission):\n    'It has no points'\n",
        "graders/{name}/checks.py:1: check test_unmarked: it lacks a mark",
    ),
}


def test_the_fault_of_one_exercise_is_named_and_costs_no_other(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A course with an exercise for each fault, and a student whose work for all of them is right."""
    content = tmp_path / "content"
    shutil.copytree(MINI, content)
    for number, (above, _) in enumerate(FAULTS.values(), 3):
        for kind in ("exercises", "graders", "solutions"):
            shutil.copytree(content / kind / "halving", content / kind / f"fault-{number}")
        toml = content / "exercises" / f"fault-{number}" / "exercise.toml"
        text = toml.read_text("utf-8").replace('id = "halving"', f'id = "fault-{number}"')
        toml.write_text(text.replace("order = 2", f"order = {number}"), "utf-8")
        checks = content / "graders" / f"fault-{number}" / "checks.py"
        if above is None:
            checks.unlink()
        else:
            checks.write_text(f"{above}\n{checks.read_text('utf-8')}", "utf-8")
    shutil.copytree(content / "solutions", tmp_path / "class" / "ada")
    monkeypatch.setenv("COURSE_CONTENT", str(content))
    options = RunOptions(terms=Terms(level="L1"), seed=1)
    summary = graded_class(tmp_path, Catalog(), options)
    assert summary.exit_code == 70
    with Gradebook(tmp_path / "out" / "gradebook.sqlite") as book:
        verdicts = {one.key.exercise: one.verdict for one in book.results()}
    assert all(verdicts[exercise].passed for exercise in ("doubling", "halving"))
    for number, (_, said) in enumerate(FAULTS.values(), 3):
        verdict = verdicts[f"fault-{number}"]
        assert (verdict.state, verdict.error and verdict.error.code) == ("grader_error", "check_file")
        assert verdict.error is not None
        assert verdict.error.message.startswith(said.replace("{name}", f"fault-{number}"))
        assert str(content) not in verdict.error.message
