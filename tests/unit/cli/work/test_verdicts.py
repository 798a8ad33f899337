"""A verdict on the screen."""

import io

import msgspec
import pytest

from course.catalog.models import Exercise, Task
from course.cli.frame.console import Console, Settings
from course.cli.work.verdict import show_verdict
from course.scoring.verdict import CheckResult, Divergence, Status, Tolerance, Verdict
from tests.unit.cli.conftest import Said

EXERCISE = Exercise(
    format_version=1,
    id="integrators",
    title="Integrators",
    module="integrators.py",
    lesson="integration",
    order=1,
    summary="",
    task=(Task("euler", "Explicit Euler", 4), Task("verlet", "Velocity Verlet", 4), Task("rk4", "RK4", 4)),
    hidden_checks=7,
)


def _check(name, task, status=Status.PASS, **fields):
    base = CheckResult(
        id=name,
        title=f"{name} works",
        task=task,
        status=status,
        visibility="public",
        points=2.0 if status == "pass" else 0.0,
        max_points=2.0,
    )
    return msgspec.structs.replace(base, **fields)


def _unwritten(name, task):
    return _check(
        name,
        task,
        Status.ERROR,
        message="Not written.",
        help="Write it.",
        diagnosis="NOT_IMPLEMENTED",
        traceback="line 3",
    )


def _shown(*checks, verbose=False, plain=True, brief=False, **fields):
    score, most = sum(c.points for c in checks), sum(c.max_points for c in checks)
    verdict = Verdict(
        exercise="integrators",
        scope="public",
        state="graded",
        score=score,
        max_score=most,
        passed=score >= 0.7 * most,
        checks=checks,
        isolation="L3",
        **fields,
    )
    out = io.StringIO()
    environ = {} if plain else {"FORCE_COLOR": "1", "NO_COLOR": "1"}
    show_verdict(
        Console(Settings(), stdout=out, environ=environ), EXERCISE, verdict, verbose=verbose, brief=brief
    )
    return Said(out.getvalue())


def test_checks_stand_under_their_task_with_its_points():
    rows = _shown(_check("a", "euler"), _check("b", "verlet"), _check("c", "euler")).rows
    assert rows == [
        "Explicit Euler: 4/4 points",
        "  pass: a works",
        "  pass: c works",
        "Velocity Verlet: 2/2 points",
        "  pass: b works",
        "All 3 public checks pass; 7 hidden checks run when it is graded.",
        "Score 6/6.",
    ]


def test_that_a_check_gives_no_points_here_is_marked_and_said_once():
    title = "The step leaves q alone"
    free = [_check(name, "euler", points=0.0, max_points=0.0, title=title) for name in "bc"]
    rows = _shown(_check("a", "euler"), *free).rows
    assert rows[1:5] == [
        "  pass: a works",
        "  pass: The step leaves q alone *",
        "  pass: The step leaves q alone *",
        "* No points here; the grading run judges it.",
    ]


def test_a_failure_says_what_was_measured_expected_and_where():
    words = _shown(
        _check(
            "a",
            "euler",
            Status.FAIL,
            message="Energy grows.",
            help="Look at the order.",
            actual=1.0,
            expected=1.01,
            units="J",
            input={"h": 0.05},
            tolerance=Tolerance(rel=0.02, source="closed form"),
            first_divergence=Divergence(t=0.05, step=1, quantity="q[0]"),
            diagnosis="EULER_IS_SEMI_IMPLICIT",
        )
    )
    assert words.rows[1:8] == [
        "  FAIL: a works  [a]",
        "    Energy grows.",
        "    Look at the order.",
        "    measured: 1 J",
        "    expected: 1.01 J, within 2 %",
        "    input: h = 0.05",
        "    differs: q[0], first at step 1, t = 0.05 s",
    ]
    words.lacks("EULER_IS_SEMI_IMPLICIT")  # a code is for instructors and for --verbose


def test_what_passed_and_what_is_not_written_yet_stands_above_what_fails():
    words = _shown(_check("a", "euler", Status.FAIL), _unwritten("b", "verlet"), _check("c", "rk4"))
    words.says_in_order("RK4", "Still to do", "Explicit Euler")


def test_a_brief_verdict_fits_a_small_terminal_and_ends_with_its_finding(monkeypatch):
    monkeypatch.setenv("COLUMNS", "80")
    words = _shown(
        *(
            _check(f"a{n}", "euler", Status.FAIL, message="Wrong sign.", actual=1.0, expected=[0.12345] * 99)
            for n in range(9)
        ),
        *(_check(f"b{n}", "verlet") for n in range(9)),
        *(_unwritten(f"c{n}", "rk4") for n in range(9)),
        brief=True,
        plain=False,
    )
    # 24 rows, less what a watch says around it: its rule, the next step, the file and the keys.
    assert len(words.rows) <= 24 - 5
    assert [words.out.count(once) for once in ("Wrong sign.", "measured", "Long lists")] == [1, 1, 1]
    words.says_in_order("to do", "a8 works", "a0 works", "Wrong sign.")


def test_functions_not_written_yet_are_listed_once():
    words = _shown(
        _unwritten("a", "euler"), _check("b", "verlet"), _unwritten("c", "rk4"), _unwritten("d", "rk4")
    )
    assert words.out.count("Write it.") == 1
    words.says_in_order("b works", "to do: Explicit Euler", "to do: RK4")
    words.says("Still to do: 0/6 points").lacks("verbose")
    two = _unwritten("c", "rk4"), _unwritten("d", "rk4")
    mended = [msgspec.structs.replace(one, help="Mend it.") for one in two]
    words = _shown(_unwritten("a", "euler"), _unwritten("b", "verlet"), _unwritten("e", "verlet"), *mended)
    assert words.out.count("rk4: Mend it.\n") == 1, "advice that is not everybody's says whose it is"


FAILS = _check("a", "euler", Status.FAIL, message="No.")
RAISED = "Your code raised NameError on line 3 of your file: name 'a' is not defined."
ABSENT = {"message": "No such function.", "help": "Define it.", "diagnosis": "MISSING_FUNCTION"}


@pytest.mark.parametrize(
    ("checks", "counts"),
    [
        (
            [_check(name, "rk4", Status.ERROR, **ABSENT) for name in "ab"],
            {"No such function.": 1, "a works": 0},
        ),
        (
            [_check(name, "rk4", Status.FAIL, message="Wrong.", help="Try.") for name in "ab"],
            {"a works": 1, "b works": 1, "Wrong.": 1, "Try.": 1},
        ),
        (
            [FAILS, _check("b", "euler", Status.SKIP, blocked_by="a")],
            {"skip: b works": 1, "Runs once a passes.": 1},
        ),
        (
            [FAILS, _check("b", "rk4", Status.SKIP, blocked_by="a")],
            {"Not written": 0, "RK4: 0/2 points": 1},
        ),
        ([_check("stray", "elsewhere")], {"stray works": 1}),
        (
            [_check("a", "euler", Status.ERROR, message=RAISED, actual="NameError: name 'a' is not defined")],
            {"name 'a' is not defined": 1},
        ),
        (
            [_check("a", "euler", Status.ERROR, message="It raised.", actual="NameError: name 'a'")],
            {"raised: NameError: name 'a'": 1},
        ),
    ],
    ids=[
        "one cause for all checks of a task", "two failures with the same words", "a check that waits",
        "a task that waits", "a task that is not listed", "an exception that the message repeats",
        "an exception that it does not",
    ],
)  # fmt: skip
def test_each_fact_is_said_once_and_none_vanishes(checks, counts):
    words = _shown(*checks, warnings=("careful",)).says("Note: careful").out
    assert {text: words.count(text) for text in counts} == counts


def test_tracebacks_are_shown_on_request_and_offered_otherwise():
    check = _check(
        "a", "euler", Status.ERROR, message="It raised.", traceback="line 3 in euler", stdout="hello"
    )
    assert _shown(check).lacks("line 3").out.count("--verbose") == 1
    _shown(check, verbose=True).says("line 3 in euler", "hello")


def test_every_status_is_a_word_of_its_own():
    for status in Status:
        word = status if status in {"pass", "skip"} else status.upper()
        _shown(_check("a", "euler", status, message="m"), _check("b", "euler")).says(f"{word}: a works")


@pytest.mark.parametrize("columns", [60, 120])
def test_lines_fit_the_terminal(monkeypatch, columns):
    monkeypatch.setenv("COLUMNS", str(columns))
    long = "a sentence that goes on and on about energy and momentum " * 4
    words = _shown(
        _check(
            "a_rather_long_identifier_of_a_check",
            "euler",
            Status.FAIL,
            message=long,
            help=long,
            actual=[0.1] * 20,
        ),
        _unwritten("b", "rk4"),
        plain=False,
    )
    assert max(map(len, words.rows)) <= columns


def test_a_brief_verdict_has_the_details_of_one_function_and_says_so():
    first = _check("a", "euler", Status.FAIL, message="First.", help="Help one.")
    second = _check("b", "verlet", Status.FAIL, message="Second.", help="Help two.")
    words = _shown(first, second, brief=True).says("Help one.", "course check").lacks("Second.")
    words.says_in_order("FAIL: Velocity Verlet  [verlet]", "FAIL: a works")
    _shown(first, second).says("Help two.")
    _shown(first, _check("b", "verlet"), brief=True).lacks("course check")
