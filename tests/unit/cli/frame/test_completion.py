"""Every value that is one of a few is completed, and each shell gets its own script."""

import contextlib
import os
import sqlite3
import typing

import pytest

from course.cli.frame.app import SHELLS, main
from course.cli.frame.registry import COMMANDS, find
from tests.command_line import as_process

#: Values that are words or places of one's own, so that there is nothing to choose from.
FREE = {
    "ADDRESS", "DIR", "EXERCISE=ID", "FILE", "KEY", "N", "NUMBER", "OUT", "PATH", "REQUIREMENT", "STEP",
    "SUBMISSIONS", "TEXT", "WORDS", "'NAME(ARGUMENTS)'",
}  # fmt: skip
#: Names that are about to be made up.
NEW = {f"author new {kind}" for kind in ("exercise", "lesson", "question", "scene", "warmup")}


def functions(app, path):
    for command in app.registered_commands:
        yield f"{path} {command.name or command.callback.__name__}", command.callback
    for group in app.registered_groups:
        yield from functions(group.typer_instance, f"{path} {group.name or group.typer_instance.info.name}")


def every_command():
    for name, entry in COMMANDS.items():
        found = find(entry.module, entry.name)
        if entry.is_group:
            yield from functions(found, name)
        else:
            yield name, found


def values():
    """Every option and argument that takes a word: its command and its declaration."""
    for path, function in every_command():
        for hint in typing.get_type_hints(function, include_extras=True).values():
            for declared in getattr(hint, "__metadata__", ()):
                if typing.get_args(hint)[0] in {str, str | None, list[str], list[str] | None}:
                    yield path, declared


def test_every_value_that_is_a_choice_is_completed():
    found = list(values())
    assert len(found) > 40  # the walk reaches the groups' commands too
    left = [
        f"{command}: {declared.metavar}"
        for command, declared in found
        if declared.metavar not in FREE and command not in NEW and declared.autocompletion is None
    ]
    assert not left


def complete(typed, monkeypatch, capsys):
    """What is offered for the last word of a line."""
    monkeypatch.setenv("_COURSE_COMPLETE", "complete_bash")
    monkeypatch.setenv("COMP_WORDS", typed)
    monkeypatch.setenv("COMP_CWORD", str(typed.count(" ")))
    capsys.readouterr()
    with pytest.raises(SystemExit):
        main()
    return set(capsys.readouterr().out.split())


@pytest.mark.parametrize(
    ("typed", "expected"),
    [
        ("course hi", {"hint"}),
        ("course check --json ", {"doubling", "halving"}),
        ("course --plain lesson ha", {"half-as-much"}),
        ("course check doubling --only double_", {"double_of_three"}),
        ("course hint doubling --task ", {"double", "doublings"}),
        ("course grade run in --layout ca", {"canvas"}),
        ("course grade run in --isolation s", {"strict"}),
        ("course grade export out --format j", {"jsonl", "junit"}),
        ("course grade export out --missing z", {"zero"}),
        ("course grade rerun out --isolation p", {"process"}),
        ("course grade run in --only a", {"anna"}),
        ("course notebook build --format n", {"nbgrader"}),
        ("course notebook check it.ipynb --exercise d", {"doubling"}),
        ("course sandbox export newtons-cradle --format m", {"mjcf"}),
        ("course sandbox play newtons-cradle --set ga", {"gap="}),
        ("course sim run free-fall --set hei", {"height="}),
        ("course schema chec", {"check", "check-all"}),
        ("course check --format g", {"github"}),
        ("course reflect doubling --grades ", {"yes", "partly", "no"}),
        ("course reflect doubling --grades yes,p", {"yes,partly"}),
        ("course init --with d", {"devcontainer"}),
        ("course init --with github,v", {"github,vscode"}),
    ],
)
def test_what_is_offered(typed, expected, course, tmp_path, monkeypatch, capsys):
    (tmp_path / "in" / "anna").mkdir(parents=True)
    assert complete(typed, monkeypatch, capsys) == expected


def test_students_of_a_run_come_from_its_gradebook(course, tmp_path, monkeypatch, capsys):
    assert complete("course grade explain out ", monkeypatch, capsys) == set()
    assert not (tmp_path / "out").exists()
    (tmp_path / "out").mkdir()
    with contextlib.closing(sqlite3.connect(tmp_path / "out" / "gradebook.sqlite")) as book:
        book.executescript(
            "CREATE TABLE results (student TEXT); CREATE TABLE students (student TEXT);"
            "CREATE TABLE runs (number INTEGER); INSERT INTO runs VALUES (7);"
            "INSERT INTO results VALUES ('anna'), ('anna'), ('bo'); INSERT INTO students VALUES ('cy');"
        )
    assert complete("course grade explain out ", monkeypatch, capsys) == {"anna", "bo", "cy"}
    assert complete("course grade rerun out --against ", monkeypatch, capsys) == {"7"}


@pytest.mark.parametrize("shell", SHELLS)
def test_each_shell_gets_its_own_script_and_an_unknown_one_is_named_with_them(course, shell):
    ran = course("--show-completion", shell).ends(0)
    marks = {"bash": "complete -o default", "zsh": "#compdef course", "fish": "complete --command course"}
    assert marks.get(shell, "Register-ArgumentCompleter") in ran.out
    assert f"complete_{shell.replace('pwsh', 'powershell')}" in ran.out
    course("--show-completion tcsh").refuses(2, shell)


def test_zsh_is_answered_in_its_own_form():
    """What zsh's script asks with, in a process of its own, as it does."""
    asked = {**os.environ, "_COURSE_COMPLETE": "complete_zsh", "_TYPER_COMPLETE_ARGS": "course hi"}
    ran = as_process(env=asked)
    assert ran.stdout.startswith("_arguments")
    assert "hint" in ran.stdout


def test_completion_is_written_where_the_shell_looks_as_help_says(course, tmp_path, monkeypatch):
    assert "name it: zsh" in course("--help").out
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.setenv("USERPROFILE", str(tmp_path))
    assert course("--install-completion zsh").code == 0
    assert "#compdef course" in (tmp_path / ".zfunc" / "_course").read_text()
