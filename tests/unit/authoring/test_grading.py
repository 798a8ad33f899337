"""Variants of a model solution are graded by the checks that can tell them from it, and to the same end."""

import msgspec
import pytest

from course.authoring.exercises.grading import (
    accepted_files,
    compose,
    grade_sources,
    mistakes_of,
    solution_path,
    source_of,
)
from course.catalog.load import Catalog
from course.grading.running.batch import Graders
from course.scoring.judging.session import GradingSession
from course.scoring.judging.submission import Submission

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


def plain(verdict):
    """A verdict without what differs from run to run."""
    checks = tuple(msgspec.structs.replace(check, duration_ms=0.0) for check in verdict.checks)
    return msgspec.structs.replace(verdict, checks=checks)


def test_every_source_gets_the_verdict_of_all_checks(mini):
    catalog = Catalog()
    exercise = catalog.exercise("doubling")
    model = solution_path(catalog, exercise)
    sources = [compose(model, path) for path in accepted_files(catalog, exercise)]
    sources += [source_of(catalog, exercise, one) for one in mistakes_of(catalog, exercise).wrong]
    sources += [f"{model.read_text('utf-8').rstrip()}\n\n\n{after}".encode() for after in AFTER.values()]
    sources += [exercise.stub_path.read_bytes(), b"def double(x):\n    return 2 * x\n", b"(", b""]
    found = dict(grade_sources([(exercise, source) for source in sources], graders=2))
    with GradingSession(exercise, catalog, scope="full") as session:
        for index, source in enumerate(sources):
            whole = session.grade(Submission({exercise.module: source}))
            assert plain(found[index]) == plain(whole), source.decode()[-80:]


@pytest.fixture
def asked(monkeypatch):
    """The checks that each grading is to run; none stands for all."""
    seen = []
    grade = Graders.grade

    def watched(self, entries):
        def noted():
            for entry in entries:
                seen.append(entry.only)
                yield entry

        return grade(self, noted())

    monkeypatch.setattr(Graders, "grade", watched)
    return seen


def test_a_check_that_cannot_see_a_change_is_not_run_again(mini, asked):
    catalog = Catalog()
    exercise = catalog.exercise("doubling")
    model = solution_path(catalog, exercise).read_text("utf-8").rstrip()
    list(grade_sources([(exercise, f"{model}\n\n\n{after}".encode()) for after in AFTER.values()]))
    tasks = ({check.split("_")[0] for check in only} or None for only in asked)
    of = dict(zip(["the model", *list(AFTER)[1:]], tasks, strict=True))  # "nothing" is the model again
    assert of["a function"] == {"double"}
    assert of["the other, by a helper"] == {"doublings"}
    assert of["a module they both use"] == {"doublings"}
    for name in ("something inside a function", "an item of a table", "what does not load"):
        assert of[name] is None, name


#: Of two checks the first asks for the function, and the second gets what came.
KEPT = '''

KEPT = {}


@pytest.mark.task("doublings")
@pytest.mark.points(1)
def test_doublings_kept(submission):
    """It is asked for once"""
    KEPT[id(submission)] = submission.call("doublings", 1.0, 2)


@pytest.mark.task("doublings")
@pytest.mark.points(1)
def test_doublings_again(submission):
    """And read twice"""
    if id(submission) not in KEPT:
        KEPT[id(submission)] = submission.call("doublings", 1.0, 2)
    kit.expect_length(KEPT.pop(id(submission)), 3, message="The number of values is wrong.", help="Count.")
'''


def test_a_check_of_what_another_one_kept_is_run_for_that_functions_changes(mini, asked):
    with (mini / "graders" / "doubling" / "checks.py").open("a", encoding="utf-8") as file:
        file.write(KEPT)
    toml = mini / "exercises" / "doubling" / "exercise.toml"
    worth = toml.read_text("utf-8").replace("hidden_points = 5", "hidden_points = 7")
    toml.write_text(worth.replace("points = 6", "points = 8"), "utf-8")
    catalog = Catalog()
    exercise = catalog.exercise("doubling")
    model = solution_path(catalog, exercise).read_text("utf-8").rstrip()
    afters = ("def double(x):\n    return x + 1.0\n", "def doublings(x, n):\n    return [x]\n")
    found = dict(grade_sources([(exercise, f"{model}\n\n\n{after}".encode()) for after in afters]))
    whole, silent, double, doublings = asked
    assert (whole, silent) == ((), ("doublings_again",))
    assert set(double) == {"double_of_three", "double_of_negative"}
    assert set(doublings) == {f"doublings_{name}" for name in ("length", "values", "kept", "again")}
    failed = [{check.id for check in found[index].checks if check.status == "fail"} for index in (0, 1)]
    assert failed == [set(double), {"doublings_length", "doublings_again"}]
