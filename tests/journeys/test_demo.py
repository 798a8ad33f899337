"""``course demo``, with the real sandbox: what it shows, and what it makes of a line that is typed."""

import ast
import io
import json
import os
import sys

import pytest

from course.catalog import models
from course.catalog.load import Catalog
from course.cli.frame import console
from course.cli.frame.console import Console, Settings, install
from course.cli.setup.demo import TRIES, demo, worked_example
from course.scoring.judging.session import GradingSession
from course.scoring.judging.submission import Submission
from tests.command_line import as_process, in_process
from tests.terminals import Terminal, needs_tmux

pytestmark = pytest.mark.usefixtures("sandboxes")

ASKS = "This line is wrong: x = x + h * v_next"


class _Screen(io.StringIO):
    def isatty(self):
        return True


@pytest.fixture
def typing(monkeypatch):
    """Run the demonstration on a terminal where these lines are typed, and no more; what it said."""

    def run(*lines, out=None, environ=None, **settings):
        out = out or _Screen()
        monkeypatch.setattr(console, "_installed", None)
        monkeypatch.setattr(sys, "stdin", _Screen("".join(f"{line}\n" for line in lines)))
        install(Console(Settings(**settings), stdout=out, environ={"TERM": "dumb", **(environ or {})}))
        assert demo() == 0
        return out.getvalue()

    return run


@pytest.mark.parametrize(
    ("line", "finding", "right"),
    [
        ("x = x + h *", "invalid syntax", "x = x + h * v"),
        ("x = x + v_next * h", "semi-implicit Euler", "x += h*v"),
        ("x + h * v", "The position never changes", "    x = h * v + x  # the old v"),
        ("x = x + h * w", "It raises NameError: name 'w' is not defined", "        x += v * h"),
        ("while True: pass", "when the time was up", "x += h * v"),
        ("x = x + h * v\udcff", "is not Python source", "x += h * v"),
    ],
)
def test_a_wrong_line_is_told_its_own_finding_and_a_right_one_in_any_spelling_fixes_the_mistake(
    typing, line, finding, right, monkeypatch
):
    monkeypatch.setattr(models, "QUICK", 0.02)  # what hangs is waited for
    before, _, after = typing(line, right).partition("Not yet. ")
    assert ASKS in before
    told, _, after = after.partition("Type the line again")
    assert finding in told.replace("\n", " ")
    assert "Not yet" not in after
    assert f"+ {right.strip()}\n" in after
    assert "All 2 public checks pass" in after
    assert "7.32 times its initial value" in after


def test_after_the_last_wrong_line_the_answer_is_shown(typing):
    said = typing(*["x = x + h"] * TRIES, "x = x + h * v  # never read")
    assert said.count("Not yet. ") == TRIES
    assert "This is the answer:" in said
    assert "+ x = x + h * v\n" in said


def test_an_unchanged_line_is_not_checked_and_costs_no_try(typing):
    said = typing(*[" x = x +  h * v_next "] * (TRIES + 1), "x += h * v")
    assert said.count("That is the line as it was.") == TRIES + 1
    assert "Not yet" not in said
    assert "+ x += h * v" in said


@pytest.mark.parametrize("lines", [["x = 1", "q"], []])
def test_q_and_the_end_of_the_input_leave(typing, lines):
    said = typing(*lines)
    assert ASKS in said
    assert "fixed" not in said


@pytest.mark.parametrize("how", [{"quiet": True}, {"out": io.StringIO()}])
def test_it_asks_only_where_a_person_reads_and_answers(typing, how):
    said = typing("q", **how)
    assert "Your turn" not in said
    assert "All 2 public checks pass" in said


def test_what_is_typed_is_run_in_the_sandbox_only_and_enter_alone_shows_the_answer(typing):
    said = typing("import os; os.environ['COURSE_TYPED'] = 'x'", "")
    assert "COURSE_TYPED" not in os.environ
    assert "Not yet" in said
    assert "+ x = x + h * v\n" in said
    assert "3. What the mistake hid" in said


@needs_tmux
def test_on_a_terminal_a_person_fixes_it_and_sees_both_motions(tmp_path):
    terminal = Terminal(tmp_path, (80, 24))
    try:
        terminal.line(f"{sys.executable} -m course demo")
        screen = terminal.wait("Type it as it should be (Enter shows the answer, q leaves):")
        assert "1. This function calls itself explicit Euler." in screen, "the whole finding fits on 24 lines"
        terminal.line("x = x + h * v")
        assert "+ x = x + h * v\n" in terminal.wait("Next: both motions.")
        terminal.keys("Enter")
        screen = terminal.wait("Next: course init my-course")
        assert "3. What the mistake hid" in screen, "the picture and its words fit on 24 lines"
        assert "before" in screen
        assert "Grey: the motion of the other panel." in screen
    finally:
        terminal.close()


@pytest.fixture(scope="module")
def worked():
    """A warm session over the worked example, as a function of the module's text; and the right text."""
    catalog = Catalog()
    example = worked_example(catalog)
    with GradingSession(example, catalog) as session:
        yield (
            lambda text: session.grade(Submission({example.module: text.encode()})),
            example.stub_path.read_text(encoding="utf-8"),
        )


def test_the_demonstration_names_a_mistake_fixes_it_and_leaves_nothing(tmp_path):
    empty = tmp_path / "empty"
    empty.mkdir()
    ran = as_process("demo", cwd=empty)
    assert ran.returncode == 0
    said = [
        "v_next = v - h * rate**2 * x",
        "0 of 2 checks pass.",
        "- x = x + h * v_next",
        "+ x = x + h * v",
        "All 2 public checks pass",
        "Next: course init",
    ]
    places = [ran.stdout.index(words) for words in said]
    assert places == sorted(places)
    assert list(empty.iterdir()) == []


def test_the_demonstration_measures_what_theory_says_of_both_methods(tmp_path):
    body = json.loads(in_process("demo", "--json", cwd=tmp_path).stdout)
    assert (body["before"]["ok"], body["after"]["ok"], body["exit_code"]) == (False, True, 0)
    assert len(body["change"]) == 2, "one line"
    rate_h = 2.0 * body["step_size"]
    # Explicit Euler multiplies the energy by 1 + (rate h)^2; semi-implicit Euler keeps it within rate h / 2.
    assert body["energy_after"] == pytest.approx([1.0, (1.0 + rate_h**2) ** body["steps"]], rel=1e-9)
    low, high = body["energy_before"]
    assert 1.0 - rate_h < low < 1.0 < high < 1.0 + rate_h


def test_no_task_has_the_signature_of_the_worked_example():
    """What `course demo` ships would answer it."""

    def signatures(exercise):
        tree = ast.parse(exercise.stub_path.read_text(encoding="utf-8"))
        return {
            (node.name, tuple(a.arg for a in node.args.args))
            for node in tree.body
            if isinstance(node, ast.FunctionDef)
        }

    catalog = Catalog()
    ((name, parameters),) = signatures(worked_example(catalog))
    taken = set().union(*map(signatures, (*catalog.exercises(), *catalog.warm_ups())))
    assert name not in {known for known, _ in taken}
    assert parameters not in {known for _, known in taken}


@pytest.mark.parametrize(
    ("what", "instead", "failed", "diagnosis"),
    [
        ("x + h * v\n", "x + h * v_next\n", "first_step", "EULER_IS_SEMI_IMPLICIT"),
        ("x + h * v\n", "x + h * v + h * v_next\n", "first_step", None),
        ("x = x + h * v\n", "x + h * v\n", "energy_grows", "POSITION_STANDS"),
        ("v - h * rate**2 * x", "v - h * rate * x", "energy_grows", None),
        ("v - h * rate**2 * x", "v + h * rate**2 * x", "energy_grows", None),
    ],
)
def test_each_check_of_the_worked_example_can_fail(worked, what, instead, failed, diagnosis):
    session, right = worked
    assert what in right
    verdict = session(right.replace(what, instead))
    assert [(c.id, c.diagnosis) for c in verdict.checks if c.status == "fail"] == [(failed, diagnosis)]
