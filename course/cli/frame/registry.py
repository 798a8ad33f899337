"""Which commands there are, and where each one lives.

Declared as data so that ``course --help`` lists them without importing any: a module is imported when its
command is run. The first line of a command's docstring is its summary here; a test compares them.
"""

import importlib
import os
import re
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from typing import Any, cast

import typer
from typer.core import TyperCommand, TyperGroup

from course.catalog.locate import content
from course.errors import CourseError, UsageError

GLOBAL_OPTIONS = "Every command also takes --json, --plain, --quiet (-q) and -C DIR."

LEARN = "Learn"
PRACTISE = "Practise"
PLAY = "Play"
HAND_IN = "Hand in"
MACHINE = "This machine"
TEACH = "For instructors"
WRITE = "For authors"


@dataclass(frozen=True, slots=True)
class Entry:
    """One command.

    Attributes:
        module, name: where it is: a function, or ``app``, a group of commands.
        panel: the heading it is listed under.
        summary: one line for lists.
        given: its arguments in the example below its help; the commands of a group have their own.
    """

    module: str
    name: str
    panel: str
    summary: str
    given: str = ""

    @property
    def is_group(self) -> bool:
        return self.name == "app"


COMMANDS: dict[str, Entry] = {
    "demo": Entry("setup.demo", "demo", LEARN, "Find and fix a mistake, without a workspace."),
    "init": Entry("setup.making", "init", LEARN, "Make a workspace.", "my-course"),
    "go": Entry("loop", "go", LEARN, "Do one task after the other, checked at every save."),
    "next": Entry("home.overview", "next_command", LEARN, "Name what is next, and open nothing."),
    "lessons": Entry("reading.commands", "lessons", LEARN, "List the lessons, with what is read."),
    "lesson": Entry("reading.commands", "lesson", LEARN, "Read one lesson.", "numerical-integration"),
    "quiz": Entry("quiz.commands", "app", LEARN, "Answer the quiz, and review what was missed."),
    "progress": Entry("home.overview", "progress", LEARN, "Show everything done so far."),
    "warmup": Entry("reading.commands", "warmup", PRACTISE, "Do a lesson's small tasks.", "fall-time"),
    "exercises": Entry("home.overview", "exercises", PRACTISE, "List the exercises."),
    "start": Entry("work.changing", "start", PRACTISE, "Put an exercise into the workspace.", "integrators"),
    "check": Entry("work.checking", "check", PRACTISE, "Run the public checks.", "integrators"),
    "watch": Entry("loop", "watch", PRACTISE, "Check again on every save.", "integrators"),
    "hint": Entry("work.hinting", "hint", PRACTISE, "Show the next hint.", "integrators"),
    "diff": Entry("work.changing", "diff", PRACTISE, "Show what changed since the stub.", "integrators"),
    "report": Entry(
        "work.checking", "report", PRACTISE, "Show what your code does, with figures.", "sim-to-real"
    ),
    "reflect": Entry(
        "work.hinting", "reflect", PRACTISE, "Answer in prose, and grade your answer.", "sim-to-real"
    ),
    "solution": Entry(
        "work.hinting", "solution", PRACTISE, "Show a released solution, after a pass.", "integrators"
    ),
    "reset": Entry("work.changing", "reset", PRACTISE, "Go back to the stub; a copy is kept.", "integrators"),
    "notebook": Entry("notebook", "app", PRACTISE, "Write notebooks, check them, bring them up to date."),
    "open": Entry("notebook", "open_notebook", PRACTISE, "Open one notebook in JupyterLab.", "integrators"),
    "sandbox": Entry("sandbox.commands", "app", PLAY, "Play with collisions, and see where the energy goes."),
    "sim": Entry("sim", "app", PLAY, "Run a simulation and compare with theory."),
    "engines": Entry("engines", "app", PLAY, "Compare real physics engines on this machine."),
    "submit": Entry("work.submitting", "submit", HAND_IN, "Write the file to hand in.", "-o mine.zip"),
    "update": Entry("work.changing", "update", MACHINE, "Bring newer course content in.", "--dry-run"),
    "doctor": Entry("setup.doctor", "doctor", MACHINE, "Say what works on this machine."),
    "bug": Entry("setup.doctor", "bug", MACHINE, "Write what a fault report needs into a file."),
    "schema": Entry("frame.replies", "schema", MACHINE, "Print the JSON Schema of a reply.", "check"),
    "grade": Entry("grade.commands", "app", TEACH, "Grade a class."),
    "author": Entry("author.commands", "app", WRITE, "Write and check the course itself."),
}


#: The command behind ``course`` alone: a module and its function.
HOME = "home.overview", "dashboard"

#: Words that other tools have for what these commands do.
ALSO: dict[str, tuple[str, ...]] = {
    **dict.fromkeys(("test", "tests", "run", "verify", "checks"), ("check",)),
    **dict.fromkeys(("list", "ls", "exercise", "tasks"), ("exercises",)),
    **dict.fromkeys(("warm-up", "warmups", "warm-ups"), ("warmup",)),
    **dict.fromkeys(("status", "home", "dashboard"), ()),
    **dict.fromkeys(("hints",), ("hint",)),
    **dict.fromkeys(("hand-in", "handin", "turn-in", "turnin"), ("submit",)),
    **dict.fromkeys(("version",), ("--version",)),
}
_NOTHING_TO_LEAVE = frozenset({"quit", "exit"})


def understood(words: tuple[str, ...]) -> tuple[str, ...]:
    """A command line with the course's own word for one of another tool; ``help WORDS`` is ``WORDS --help``.

    Raises:
        UsageError: it asks to leave, and no command goes on after its answer.
    """
    if not words or words[0] in COMMANDS:
        return words
    first, rest = words[0], words[1:]
    if first in _NOTHING_TO_LEAVE:
        problem = "There is nothing to leave: every command ends by itself."
        raise UsageError(problem, help="In a lesson, in `course watch` and in the sandbox, the key q leaves.")
    if first == "help":
        return (*understood(rest), "--help")
    return (*ALSO[first], *rest) if first in ALSO else words


class LazyGroup(TyperGroup):
    """A group that knows its commands by name and loads the one that is run."""

    def list_commands(self, ctx: Any) -> list[str]:  # noqa: ARG002 - the signature is typer's
        """Names in the order they are listed; what needs a checkout is offered in one."""
        whole = True
        with suppress(CourseError):  # where the course itself cannot be found, that is said later
            whole = content().is_checkout
        return [name for name, entry in COMMANDS.items() if whole or entry.panel not in {TEACH, WRITE}]

    def format_commands(self, ctx: Any, formatter: Any) -> None:
        """The list of commands in plain help, under the same headings as on a terminal."""
        panels: dict[str, list[tuple[str, str]]] = {}
        for name in self.list_commands(ctx):
            panels.setdefault(COMMANDS[name].panel, []).append((name, COMMANDS[name].summary))
        widest = max(len(name) for name in COMMANDS)
        for panel, rows in panels.items():
            with formatter.section(panel):
                formatter.write_dl([(name.ljust(widest), summary) for name, summary in rows])

    def get_command(self, ctx: Any, cmd_name: str) -> Any:  # noqa: ARG002 - the signature is typer's
        """A stand-in with the name and the summary, which is all that a list needs."""
        entry = COMMANDS.get(cmd_name)
        if entry is None:
            return None
        mode = self.rich_markup_mode
        return TyperCommand(cmd_name, help=entry.summary, rich_help_panel=entry.panel, rich_markup_mode=mode)

    def resolve_command(self, ctx: Any, args: list[str]) -> Any:
        """The real command, for the one that is run or completed."""
        self.commands = cast("Any", dict.fromkeys(COMMANDS))  # only the names, for "did you mean"
        name, command, rest = super().resolve_command(ctx, args)
        if command is not None and name is not None:
            command = _load(name, COMMANDS[name], self.rich_markup_mode)
        return name, command, rest


#: Of every command and every group of them.
OPTIONS: dict[str, Any] = {
    "pretty_exceptions_enable": False,
    "context_settings": {"help_option_names": ["-h", "--help"]},
}


def group(summary: str) -> typer.Typer:
    """A group of commands, without them; alone it shows its help."""
    return typer.Typer(help=summary, no_args_is_help=True, **OPTIONS)


def build(*, fancy: bool) -> typer.Typer:
    """The empty program: its commands come from ``COMMANDS``."""
    markup: Any = "rich" if fancy else None
    return typer.Typer(
        name="course", cls=LazyGroup, invoke_without_command=True, rich_markup_mode=markup, **OPTIONS
    )


def find(module: str, name: str) -> Any:
    """A function of a room, which is imported now."""
    return getattr(importlib.import_module(f"course.cli.{module}"), name)


def _load(name: str, entry: Entry, mode: Any) -> Any:
    target = find(entry.module, entry.name)
    if entry.is_group:
        target.info.name = name
        target.rich_markup_mode = mode
        return _with_global_options(typer.main.get_group(target))
    app = typer.Typer(add_completion=False, rich_markup_mode=mode, **OPTIONS)
    app.command(name, epilog=f"Example: course {name} {entry.given}".rstrip())(target)
    return _with_global_options(typer.main.get_command(app))


def _with_global_options(command: Any) -> Any:
    """The command, or every command of a group, whose help names them at its end."""
    for one in getattr(command, "commands", {}).values():
        _with_global_options(one)
        one.short_help = (one.help or "").partition("\n")[0]  # uncut
    # Rich's help would keep the line breaks of a docstring, in all of its paragraphs but the first.
    paragraphs = (command.help or "").split("\n\n")
    command.help = "\n\n".join(" ".join(one.split()) for one in paragraphs)
    if not hasattr(command, "commands"):
        command.callback = _with_texts(command)
        command.epilog = "\n\n".join(filter(None, (command.epilog, GLOBAL_OPTIONS)))
    return command


def _with_texts(command: Any) -> Callable[..., Any]:
    """What the command does, given texts that a file can hold; a path may be any bytes."""
    texts = {one.name for one in command.params if one.type.name in {"str", "text"}}
    run = command.callback

    def given(**values: Any) -> Any:
        for name in texts & values.keys():
            value = values[name]
            if isinstance(value, str):
                values[name] = _text(value)
            elif isinstance(value, list | tuple):
                values[name] = [_text(word) for word in value]
        return run(**values)

    return given


def _text(word: str) -> str:
    """A word of the line as text; where the locale is not UTF-8, its bytes may be.

    Raises:
        UsageError: they are not.
    """
    if not re.search("[\ud800-\udfff]", word):
        return word
    try:
        return os.fsencode(word).decode("utf-8")
    except UnicodeError:
        raise UsageError(f"{word!r} is not UTF-8.", help="Type it again, in UTF-8.") from None
