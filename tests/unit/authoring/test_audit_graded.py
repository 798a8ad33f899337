"""The audit with the real grader: a few faults that only running the code can show."""

from course.authoring.audit import audit
from course.authoring.exercises.grading import grade_sources
from course.authoring.exercises.proofs import run_mutants
from course.catalog.load import Catalog
from tests.unit.authoring.conftest import edit


def test_a_stub_that_already_works_is_found(mini):
    edit(mini / "exercises/halving/halving.py", "raise NotImplementedError", "return x / 2")
    found = [p for p in audit(Catalog(), "halving").problems if p.code == "stub"]
    assert any("the untouched stub passes check half_of_odd" in p.message for p in found)
    assert any("no check of task halve fails" in p.message for p in found)


def test_a_stub_that_cannot_be_loaded_is_found(mini):
    edit(
        mini / "exercises/halving/halving.py", "def halve", "import absent\nx = len(absent.x)\n\n\ndef halve"
    )
    found = [p.message for p in audit(Catalog(), "halving").problems if p.code == "stub"]
    assert any("left out. It uses a package that is not there." in message for message in found)


def test_a_check_that_breaks_is_not_the_solutions_fault(mini):
    edit(mini / "graders/halving/checks.py", "3.5,", "3.5 / 0,")
    problems = audit(Catalog(), "halving").problems
    assert {p.code for p in problems} == {"grader"}
    assert any("ZeroDivisionError" in p.message for p in problems)


def test_the_words_of_a_hidden_check_are_read_as_a_student_gets_them(mini):
    edit(
        mini / "graders/halving/checks.py",
        'message="Half of an odd number has lost its fraction."',
        'message=f"It is not {7 / 2}."',
    )
    problems = audit(Catalog(), "halving").problems
    assert {p.code for p in problems} == {"leak"}
    assert {p.where for p in problems} == {"graders/halving/checks.py:10"}


def test_what_each_mutant_gets_to_read_can_be_listed(mini):
    catalog = Catalog()
    steps = []
    outcomes = run_mutants(
        catalog, catalog.exercise("doubling"), on_progress=lambda done, *_: steps.append(done)
    )
    first = outcomes[0]
    assert first.mutant.name == "double.SQUARES_INSTEAD"
    assert (first.diagnosis, first.lost) == ("SQUARES_INSTEAD", 4.0)
    assert first.caught_by == ("double_of_three", "double_of_negative")
    assert "multiplied by itself" in first.message
    assert first.help == "Add the number to itself, or multiply it by two."
    assert all(outcome.faults == () for outcome in outcomes)
    assert steps == [*range(9)]


def test_a_field_that_no_failed_check_has_is_a_problem(mini):
    path = mini / "exercises/doubling/exercise.toml"
    edit(path, "[task.fits]", '[task.yours]\n2 = ["At {x} it is {got}.", "At {y} too."]\n\n[task.fits]')
    (problem,) = audit(Catalog(), "doubling").problems
    assert problem.where == "exercises/doubling/exercise.toml:23"
    assert "no check of double that a mutant fails has the field {y}" in problem.message
    # A program that got no verdict may have it; it does not count as graded.
    some = audit(Catalog(), "doubling", grade=lambda sources: grade_sources(sources[:-1]))
    assert (some.problems, some.graded) == ((), 13)


def test_checks_that_cannot_be_collected_are_a_problem_like_any_other(mini):
    edit(
        mini / "exercises/halving/checks.py",
        "import pytest\n",
        "import pytest\nimport nothing_of_that_name\n",
    )
    problems = audit(Catalog(), "halving").problems
    assert [p.file for p in problems] == ["exercises/halving/checks.py"]
    assert "nothing_of_that_name" in problems[0].message


def test_a_marker_may_be_computed(mini):
    edit(mini / "graders/halving/checks.py", 'task("halve")', "task(TASK)")
    edit(mini / "graders/halving/checks.py", "points(1)", "points(3 - 2)")
    edit(
        mini / "graders/halving/checks.py", "import pytest\n", 'import pytest\n\nTASK, OTHER = "halve", ""\n'
    )
    assert audit(Catalog(), "halving").problems == ()
