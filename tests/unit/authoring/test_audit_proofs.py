"""What the audit finds by grading: with a grader that answers from a script, and with the real one."""

import msgspec
import pytest

from course.authoring.audit import audit
from course.authoring.exercises.grading import grade_sources
from course.authoring.exercises.proofs import run_mutants
from course.catalog.load import Catalog
from course.scoring.verdict import OURS, Problem, Status
from tests.unit.authoring.conftest import edit

CHECKS = "exercises/doubling/checks.py"
HIDDEN = "graders/doubling/checks.py"
STUB = "exercises/doubling/doubling.py"
SOLUTION = "solutions/doubling/doubling.py"
ADDS = "solutions/doubling/accepted/adds.py"
MISTAKES = "solutions/doubling/mistakes.py"


def with_check(check_id, **fields):
    def change(verdict):
        checks = tuple(
            msgspec.structs.replace(check, **fields) if check.id == check_id else check
            for check in verdict.checks
        )
        return msgspec.structs.replace(verdict, checks=checks, score=sum(check.points for check in checks))

    return change


def ending(state, message):
    return lambda verdict: msgspec.structs.replace(
        verdict, state=state, checks=(), score=0.0, error=Problem("code", message, "Do this.")
    )


passing = {"status": Status.PASS, "diagnosis": None}
failing = {"status": Status.FAIL, "points": 0.0}


def squares(change, says):
    """What is said of a mutant at its line."""
    return "double.SQUARES_INSTEAD", change, f"{MISTAKES}:7", "mutant", says


def without_the_first(verdict):
    return msgspec.structs.replace(verdict, checks=verdict.checks[1:])


def with_one_more(verdict):
    more = msgspec.structs.replace(verdict.checks[0], id="made_by_a_loop")
    return msgspec.structs.replace(verdict, checks=(*verdict.checks, more))


@pytest.mark.parametrize(
    ("name", "change", "where", "code", "says"),
    [
        (
            "stub",
            with_check("double_of_three", **passing, points=2.0),
            f"{CHECKS}:12",
            "stub",
            "the untouched stub passes check double_of_three",
        ),
        ("stub", ending("ungradable", "It raises."), STUB, "stub", "It raises."),
        (
            "solution",
            with_check("double_of_three", **failing, message="No.", expected=6.0, actual=5.0),
            f"{SOLUTION}:6",
            "solution",
            "check double_of_three ends with fail: No. (expected 6.0, got 5.0)",
        ),
        ("solution", with_check("double_of_three", points=1.0), SOLUTION, "solution", "scores 9 of 10"),
        (
            "solution",
            without_the_first,
            f"{CHECKS}:12",
            "check",
            "check double_of_three is declared, but did not run",
        ),
        ("solution", with_one_more, CHECKS, "check", "check made_by_a_loop ran, but no plain"),
        (
            "adds.py",
            with_check("double_of_negative", status=Status.TIMEOUT, points=0.0, message="Slow."),
            f"{ADDS}:4",
            "accepted",
            "ends with timeout: Slow.",
        ),
        ("adds.py", ending("ungradable", "No such module."), ADDS, "accepted", "No such module."),
        squares(
            with_check("double_of_three", **passing, points=2.0), "mutant double.SQUARES_INSTEAD survives"
        ),
        squares(
            with_check("double_of_three", diagnosis="SIGN_LOST"),
            "is diagnosed as SIGN_LOST by double_of_three (fail), not as SQUARES_INSTEAD",
        ),
        squares(
            with_check("doublings_length", **failing, message="No."),
            "fails check doublings_length of task doublings, and should break double only",
        ),
        squares(
            with_check("doublings_values", status=Status.SKIP, points=0.0, blocked_by="x"),
            "fails check doublings_values of task doublings",
        ),
        squares(with_check("double_of_three", points=2.0), "loses no points"),
        squares(
            ending("ungradable", "Syntax."), "mutant double.SQUARES_INSTEAD could not be graded: Syntax."
        ),
        (
            "double.SQUARES_INSTEAD",
            with_check("double_of_three", traceback=f"{OURS}KeyError: 3 ({HIDDEN}, line 4)"),
            f"{HIDDEN}:4",
            "grader",
            "the diagnosis of check double_of_three breaks on double.SQUARES_INSTEAD: KeyError: 3.",
        ),
        (
            "double.SQUARES_INSTEAD",
            ending("grader_error", "KeyError in a check."),
            CHECKS,
            "grader",
            "the checks break on double.SQUARES_INSTEAD: KeyError in a check.",
        ),
        (
            "doublings.STARTS_LATE",
            with_check("doublings_values", status=Status.GRADER_ERROR, message="ZeroDivisionError"),
            f"{HIDDEN}:30",
            "grader",
            "breaks: ZeroDivisionError",
        ),
    ],
)
def test_a_verdict_that_should_be_another_is_reported(oracle, run, name, change, where, code, says):
    oracle.changes[name] = change
    problems = run().problems
    found = [p for p in problems if (p.where, p.code) == (where, code)]
    assert found, [f"{p.where} {p.code} {p.message}" for p in problems]
    assert says in found[0].message
    assert found[0].help


def test_a_line_that_breaks_several_checks_is_named_once(oracle, only_problem):
    def broken(verdict):
        said = f"{OURS}KeyError: there are no words for SQUARE ({HIDDEN}, line 4)"
        for check in ("double_of_three", "double_of_negative"):
            verdict = with_check(check, traceback=said)(verdict)
        return verdict

    oracle.changes["double.SQUARES_INSTEAD"] = broken
    assert "as `mistakes.py` has it" in only_problem().help


def test_a_mutant_caught_only_by_another_check_is_reported(oracle, only_problem):
    def by_the_other(verdict):
        verdict = with_check("double_of_three", **passing, points=2.0)(verdict)
        return with_check("double_of_negative", status=Status.FAIL, points=0.0)(verdict)

    oracle.changes["double.SQUARES_INSTEAD"] = by_the_other
    assert "is not caught by double_of_three" in only_problem().message


@pytest.mark.parametrize(("told", "accepted"), [("SIGN_LOST", True), (None, True), ("STARTS_LATE", False)])
def test_a_mutant_may_be_told_what_else_is_true_of_it(mini, oracle, run, told, accepted):
    path = mini / MISTAKES
    path.write_text(path.read_text().replace('"x * x"})', '"x * x"}, also=("SIGN_LOST", ""))', 1))
    oracle.changes["double.SQUARES_INSTEAD"] = with_check("double_of_three", diagnosis=told)
    found = [p.message for p in run().problems if "double.SQUARES_INSTEAD is diagnosed" in p.message]
    assert (not found) is accepted


@pytest.mark.parametrize(
    ("check", "says"), [("no_such", "there is no such check"), ("doublings_length", "belongs to task")]
)
def test_a_mutant_is_on_record_with_a_check_of_its_task(mini, oracle, run, check, says):
    path = mini / "solutions/doubling/record.json"
    path.write_text(path.read_text().replace(':"double_of_three"', f':"{check}"'))
    oracle.changes["double.SQUARES_INSTEAD"] = with_check("double_of_three", status=Status.FAIL, points=0.0)
    found = [p for p in run().problems if says in p.message and "double.SQUARES_INSTEAD " in p.message]
    assert [p.where for p in found] == [f"{MISTAKES}:7"]


@pytest.mark.parametrize(
    ("fields", "number"),
    [
        ({"message": "It is not 34.5."}, "34.5"),
        ({"message": "Wrong.", "help": "Within 3e-11."}, "3e-11"),
        ({"message": "There are 29 of them.", "expected": 29, "actual": 28}, "29"),
        ({"message": "There are 29 of them.", "input": {"n": [1, 29]}}, "29"),
    ],
)
def test_a_hidden_check_must_not_say_its_values(oracle, run, fields, number):
    oracle.changes["double.SIGN_LOST"] = with_check("double_of_negative", **fields)
    found = [p for p in run().problems if p.code == "leak"]
    assert [p.where for p in found] == [f"{HIDDEN}:12"]
    assert f"shows the number {number}" in found[0].message


@pytest.mark.parametrize(
    ("check", "fields"),
    [
        ("double_of_negative", {"message": "Use RK4, see section 12.", "expected": 4}),
        ("double_of_negative", {"message": "There are 2 of them.", "expected": 2}),
        ("double_of_three", {"message": "It is not 34.5."}),
    ],
)
def test_small_numbers_and_public_checks_may_be_said(oracle, run, check, fields):
    name = "double.SIGN_LOST" if check == "double_of_negative" else "double.SQUARES_INSTEAD"
    oracle.changes[name] = with_check(check, **fields)
    assert run().ok


def test_progress_counts_up_to_the_end(mini, oracle):
    steps = []
    report = audit(Catalog(), on_progress=lambda *step: steps.append(step), grade=oracle.grade)
    assert [done for done, _, _ in steps] == [*range(22), 22]
    assert {total for _, total, _ in steps} == {report.graded}
    assert steps[1][2] == "doubling: stub doubling.py"


# -- what only running the code can show -----------------------------------------------------------------


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
