"""What is said, in each of the three shapes."""

import io
import json

import pytest

from course.cli.frame.console import Console, Settings, meter
from course.cli.frame.replies import Bare
from course.errors import InternalError
from tests.unit.cli.conftest import Terminal, uncoloured


def _console(*, terminal=True, environ=None, **settings):
    out = Terminal() if terminal else io.StringIO()
    err = io.StringIO()
    return Console(Settings(**settings), stdout=out, stderr=err, environ=environ or {}), out, err


def test_a_pipe_gets_one_fact_a_line_however_long_and_a_table_with_every_name():
    console, out, _ = _console(terminal=False)
    console.item("fail", "word " * 60, "end", indent=2)
    console.table(("Id", "Score"), [("one", "3/4"), ("two", "")])
    assert out.getvalue() == "  fail: " + "word " * 60 + "end\nId: one; Score: 3/4\nId: two\n"


@pytest.mark.parametrize(
    ("environ", "settings", "fancy"),
    [
        ({}, {}, True),
        ({"TERM": "dumb"}, {}, False),
        ({"TERM": "dumb", "FORCE_COLOR": "1"}, {}, False),
        ({}, {"plain": True}, False),
        ({"FORCE_COLOR": "1"}, {"json": True}, False),
    ],
)
def test_which_shape_a_terminal_gets(environ, settings, fancy):
    assert _console(environ=environ, **settings)[0].fancy is fancy


def test_colour_can_be_forced_into_a_pipe_and_forbidden_on_a_terminal():
    for terminal, environ in ((False, {"FORCE_COLOR": "1"}), (True, {"NO_COLOR": "1"})):
        console, out, _ = _console(terminal=terminal, environ=environ)
        console.line(("red", "red"))
        assert ("\x1b[31m" in out.getvalue()) is not terminal


@pytest.mark.parametrize("columns", [40, 59])
def test_a_narrow_window_gets_facts_in_place_of_a_table(monkeypatch, columns):
    monkeypatch.setenv("COLUMNS", str(columns))
    console, out, _ = _console(environ={"NO_COLOR": "1"})
    console.table(("Id", "Lesson", "Read"), [("numerical-integration", "How a simulator moves time", "")])
    rows = [line.rstrip() for line in out.getvalue().splitlines()]
    assert rows == ["numerical-integration", "  Lesson How a simulator moves time"]


def test_a_bar_knows_how_much_there_is_when_it_appears(monkeypatch):
    monkeypatch.setattr("course.cli.frame.console.PATIENCE", -1.0)
    console, out, _ = _console()
    with meter(console) as step:
        step(1, 3, "graded")
    assert "1/3" in out.getvalue()
    assert "None" not in out.getvalue()


@pytest.mark.parametrize("terminal", [True, False])
def test_control_characters_are_shown_and_not_obeyed(terminal):
    console, out, err = _console(terminal=terminal, environ={"NO_COLOR": "1"})
    evil = "a\x1b]0;title\x07b\x9b2Jc\rd"
    console.line(evil)
    console.item("x", evil)
    console.block(evil)
    console.table(("x",), [(evil,)])
    console.error(evil, evil)
    console.warn(evil)
    for text in (out.getvalue(), err.getvalue()):
        assert not {"\x1b]", "\x07", "\x9b", "\r"} & {*text, *(text[i : i + 2] for i in range(len(text)))}
        assert "\\x1b" in text


def test_under_json_people_are_spoken_to_on_standard_error_and_a_second_object_is_refused():
    console, out, err = _console(json=True)
    console.line("words")
    console.emit(Bare(schema="course.x/1", ok=True, exit_code=0))
    assert err.getvalue() == "words\n"
    assert json.loads(out.getvalue()) == {"schema": "course.x/1", "ok": True, "exit_code": 0}
    with pytest.raises(InternalError):
        console.emit(Bare(schema="course.x/1", ok=True, exit_code=0))


@pytest.mark.parametrize(
    ("answer", "agreed"),
    [("y\n", True), ("Yes\n", True), ("\n", False), ("", False), (io.StringIO("y\n"), False)],
)
def test_a_person_is_asked_and_nobody_there_means_no(monkeypatch, answer, agreed):
    there = isinstance(answer, str)
    monkeypatch.setattr("sys.stdin", Terminal(answer) if there else answer)
    console, out, _ = _console()
    assert console.confirm("Really?") is agreed
    ends = "" if answer else "\n"  # which Ctrl-D does not type
    assert out.getvalue() == (f"Really? [y/N] {ends}" if there else "")


@pytest.mark.parametrize(("then", "on"), [("\n", True), ("q\n", False), ("n\n", False), ("", False)])
def test_a_person_is_asked_whether_to_go_on_and_a_command_typed_there_does_not(monkeypatch, then, on):
    for typed in ("", "course check spring\n"):
        console, out, _ = _console()
        monkeypatch.setattr("sys.stdin", io.StringIO(typed + then))
        assert console.go_on("Page 1 of 2.") is on
        refused = "'course check spring' was not run: this is not the shell yet." in out.getvalue()
        assert refused is bool(typed)
    monkeypatch.setenv("COLUMNS", "40")
    console, out, _ = _console()
    console.go_on("Next: both motions.")
    assert out.getvalue() == "Next: both motions. Enter goes on, q\nstops: \n", "room for the answer"


@pytest.mark.parametrize("indent", [0, 4])
def test_an_address_longer_than_a_line_stays_in_one_piece(monkeypatch, indent):
    monkeypatch.setenv("COLUMNS", "60")
    console, out, _ = _console(environ={"NO_COLOR": "1"})
    address = f"http://localhost:8888/lab?token={48 * 'a'}"
    console.line("It is at ", (address, "bold"), indent=indent)
    assert uncoloured(out.getvalue()).splitlines() == [" " * indent + f"It is at {address}"]


@pytest.mark.parametrize(("typed", "seen"), [("\n\n\n\n", 20), ("\nq\n", 10), ("", 5)])
def test_a_long_answer_stops_at_each_screenful(monkeypatch, typed, seen):
    monkeypatch.setattr("sys.stdin", Terminal(typed))
    monkeypatch.setenv("LINES", "6")
    monkeypatch.setenv("COLUMNS", "60")
    console, out, _ = _console()
    with console.paged():
        for number in range(20):
            console.line(f"fact {number}.")
    console.line("after")
    words = out.getvalue()
    assert words.count("fact") == seen
    assert words.count("q stops") == -(-seen // 5) - (seen == 20)
    assert words.rstrip().endswith("after")


def test_a_short_answer_and_a_pipe_stop_nowhere(monkeypatch):
    monkeypatch.setattr("sys.stdin", Terminal(""))
    monkeypatch.setenv("LINES", "6")
    for terminal, lines in ((True, 5), (False, 50)):
        console, out, _ = _console(terminal=terminal)
        with console.paged():
            for number in range(lines):
                console.line(f"fact {number}.")
        assert out.getvalue().count("fact") == lines
        assert "q stops" not in out.getvalue()


def test_words_wrap_on_a_terminal_without_layout_and_stay_on_one_line_under_plain(monkeypatch):
    monkeypatch.setenv("COLUMNS", "40")
    words = "equilibrium " * 10 + "https://example.org/" + "x" * 60
    for settings, most in (({}, 40), ({"plain": True}, len(words))):
        console, out, _ = _console(environ={"TERM": "dumb"}, **settings)
        console.line(words)
        console.item("help", words, indent=2)
        rows = out.getvalue().splitlines()
        assert sum(row.count("https://example.org/" + "x" * 60) for row in rows) == 2
        assert max(len(row) for row in rows if "https" not in row or settings) >= min(most, 30)
        assert all(len(row) <= most + 8 for row in rows if "https" not in row)
        assert " ".join(out.getvalue().split()) == f"{words} help: {words}"


def test_errors_and_warnings_break_between_words_on_a_terminal_only(monkeypatch):
    monkeypatch.setenv("COLUMNS", "40")
    words = "integrators/integrators.py " * 4 + "counts."
    for err, settings, rows in (
        (Terminal(), {}, 9),
        (Terminal(), {"plain": True}, 3),
        (io.StringIO(), {}, 3),
    ):
        console = Console(Settings(**settings), stdout=Terminal(), stderr=err, environ={})
        console.error(words, "Do it.")
        console.warn(words)
        said = err.getvalue()
        assert said.count("\n") == rows
        assert " ".join(said.split()) == f"{words} Do it. Note: {words}", "no word is broken"


def test_a_window_that_becomes_narrower_is_seen(monkeypatch):
    console, out, _ = _console(environ={"NO_COLOR": "1"})
    for columns in (80, 40):
        monkeypatch.setenv("COLUMNS", str(columns))
        console.line("word " * 30)
    rows = [len(row.rstrip()) for row in out.getvalue().splitlines()]
    assert max(rows[:2]) > 70
    assert max(rows[2:]) <= 40


def test_a_label_that_leaves_no_room_has_its_text_below_it(monkeypatch):
    monkeypatch.setenv("COLUMNS", "40")
    console, out, _ = _console(environ={"NO_COLOR": "1"})
    console.item("Anna-Lena Schmidt collisions", "nothing was handed in", style="bold")
    rows = [line.strip() for line in uncoloured(out.getvalue()).splitlines()]
    assert rows == ["Anna-Lena Schmidt collisions", "nothing was handed in"]
