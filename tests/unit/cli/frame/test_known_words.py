"""Words of a line: global options, those of other tools, choices where one is missing, help by use."""

import json

import pytest

from course.cli.frame.console import filled
from course.cli.frame.options import global_options
from course.cli.frame.registry import ALSO, COMMANDS
from tests.unit.cli.conftest import MINI_COURSE


@pytest.mark.parametrize(
    ("word", "own"),
    [
        ("test", ["check"]),
        ("verify", ["check"]),
        ("run", ["check"]),
        ("list", ["exercises"]),
        ("status", []),
        ("warm-ups", ["warmup"]),
        ("version", ["--version"]),
    ],
)
def test_a_word_of_another_tool_does_what_it_means(course, workspace, write, word, own):
    write("RIGHT", "wrong")
    said, meant = course(word, "--json"), course(*own, "--json")
    assert said.code == meant.code
    assert said.json["schema"] == meant.json["schema"]
    assert not {*ALSO} & {*COMMANDS}


def test_a_double_dash_ends_the_search_for_global_options():
    line = global_options(["check", "--", "--json", "-C"])
    assert not line.settings.json
    assert line.rest == ("check", "--", "--json", "-C")
    assert not line.problem


@pytest.mark.parametrize("words", [["-C", "a/b", "check"], ["check", "-Ca/b"], ["-Ca", "check", "-C", "b"]])
def test_the_folder_may_be_attached_and_two_add_up(words):
    line = global_options(words)
    assert line.settings.directory in {"a/b", "a\\b"}
    assert line.rest == ("check",)


def test_help_before_a_command_is_its_help(course):
    assert course("help", "check").out == course("check", "--help").out
    assert course("help").out == course("--help").out


@pytest.mark.parametrize("word", ["quit", "exit"])
def test_who_wants_to_leave_is_told_that_nothing_runs(course, word):
    course(word).refuses(2, "every command ends by itself")
    assert json.loads(course(word, "--json").out)["error"]["code"] == "usage"


def test_a_choice_that_is_missing_is_shown(course, workspace):
    assert "Known: mjcf, sdf." in course("sandbox", "export", "head-on").err
    course("start").refuses(2, "Known: doubling")


def test_help_is_grouped_by_use_and_offers_what_works_here(course, students_content, monkeypatch):
    assert "For instructors:" not in (said := course("--help", "--plain").out)
    assert "For authors:" not in said
    assert "submit" in said
    monkeypatch.setenv("COURSE_CONTENT", str(MINI_COURSE))
    said = course("--help", "--plain").out
    headings = [
        "Learn:",
        "Practise:",
        "Play:",
        "Hand in:",
        "This machine:",
        "For instructors:",
        "For authors:",
    ]
    assert [line for line in said.splitlines() if line in headings] == headings

    monkeypatch.setenv("COURSE_CONTENT", "nowhere")
    assert course("--help", "--plain").code == 0


@pytest.mark.parametrize(
    "command",
    [
        "`course grade rerun 'my grades' --against 1`",
        "pip install 'starlette>=7.5' 'uvicorn<9,>=8' 'websockets'",
    ],
)
def test_a_command_that_is_copied_is_never_broken(command):
    rows = filled(f"Grade these again with what the run itself had been graded with: {command}", 40).split(
        "\n"
    )
    assert len(rows) > 1
    assert any(command in row for row in rows)
    assert all(len(row) <= 40 for row in rows if command not in row)
