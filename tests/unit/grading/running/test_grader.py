"""One grader and many exercises: few sessions are open at a time, and verdicts are the same."""

import contextlib
import shutil
from unittest.mock import Mock

import pytest

from course.catalog.load import Catalog
from course.grading.gradebook.book import Gradebook
from course.grading.running import grader
from course.grading.running.grader import Config, Job
from course.grading.running.run import RunOptions
from course.isolation.probe import kept_sandboxes
from course.scoring.judging import session
from course.scoring.judging.submission import Terms
from tests.unit.grading.made import graded_class

ORDER = ("doubling", "halving", "doubling", "doubling", "halving")


@pytest.mark.parametrize(("most", "opened"), [(1, 4), (2, 2)])
def test_a_grader_closes_its_oldest_session_for_another(catalog, monkeypatch, most, opened):
    monkeypatch.setenv("COURSE_CONTENT", str(catalog.content.root))
    monkeypatch.setattr(grader, "_MOST_OPEN", most)
    collected = Mock(wraps=session.CollectedChecks)
    monkeypatch.setattr(session, "CollectedChecks", collected)
    with contextlib.closing(grader._Grader(Config(Terms(), 0))) as one, kept_sandboxes():
        for exercise in ORDER:
            solution = catalog.content.root / "solutions" / exercise / f"{exercise}.py"
            verdict = one.answer(Job(exercise, {solution.name: solution.read_bytes()})).verdict
            assert (verdict.exercise, verdict.all_pass) == (exercise, True)
            assert len(one._sessions) <= most
    assert collected.call_count == opened


# -- a fault in the files of one exercise --------------------------------------------------------------------

_NOT = "graders/{name}/checks.py:1: it cannot be imported ("
_MORE = """\
import pytest
@pytest.mark.task("halve")
@pytest.mark.points(10)
def test_more(submission):
    "It is worth more than the whole exercise"
"""
#: What stands above an exercise's hidden checks, if there are any, and what is said of it.
FAULTS = [
    ("import no_such_module", f"{_NOT}ModuleNotFoundError: No module named 'no_such_"),
    ("1 / 0", f"{_NOT}ZeroDivisionError: division by zero)."),
    ("def (:", f"{_NOT}SyntaxError: "),
    ("raise SystemExit", f"{_NOT}SystemExit)."),
    (
        "open(__file__[:-9] + '../../solutions/halving/accepted/by_hand.py')",  # which graders do not have
        f"{_NOT}FileNotFoundError: solutions/halving/accepted/",
    ),
    (
        "from course.scoring import nothing_of_this_name",
        f"{_NOT}ImportError: cannot import name 'nothing_of_th",
    ),
    (None, "graders/{name}/checks.py: it is missing, and {name} has "),
    (
        "def test_unmarked(submission):\n    'It has no points'\n",
        "graders/{name}/checks.py:1: check test_unmarked: it lacks a mark",
    ),
    (_MORE, "exercises/{name}/exercise.toml: it says 2 points, and the checks are worth 12."),
]


def test_the_fault_of_one_exercise_is_named_and_costs_no_other(tmp_path, copied):
    """A course with an exercise for each fault, and a student whose work for all of them is right."""
    for number, (above, _) in enumerate(FAULTS, 3):
        for kind in ("exercises", "graders", "solutions"):
            shutil.copytree(copied / kind / "halving", copied / kind / f"fault-{number}")
        toml = copied / "exercises" / f"fault-{number}" / "exercise.toml"
        text = toml.read_text("utf-8").replace('id = "halving"', f'id = "fault-{number}"')
        toml.write_text(text.replace("order = 2", f"order = {number}"), "utf-8")
        checks = copied / "graders" / f"fault-{number}" / "checks.py"
        if above is None:
            checks.unlink()
        else:
            checks.write_text(f"{above}\n{checks.read_text('utf-8')}", "utf-8")
    shutil.copytree(copied / "solutions", tmp_path / "class" / "ada")
    options = RunOptions(terms=Terms(level="L1"), seed=1)
    summary = graded_class(tmp_path, Catalog(), options)
    assert summary.exit_code == 70
    with Gradebook(tmp_path / "out" / "gradebook.sqlite") as book:
        verdicts = {one.key.exercise: one.verdict for one in book.results()}
    assert all(verdicts[exercise].passed for exercise in ("doubling", "halving"))
    for number, (_, said) in enumerate(FAULTS, 3):
        name = f"fault-{number}"
        verdict = verdicts[name]
        assert (verdict.state, verdict.error and verdict.error.code) == ("grader_error", "check_file")
        assert verdict.error.message.startswith(said.replace("{name}", name))
        assert str(copied) not in verdict.error.message
