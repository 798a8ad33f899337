"""Which commands there are, and where each one lives.

Declared as data so that ``course --help`` lists them without importing any: a module is imported when its
command is run. The first line of a command's docstring is its summary here; a test compares them.
"""

from __future__ import annotations

import importlib
from dataclasses import dataclass
from typing import Any, cast

import typer
from typer.core import TyperCommand, TyperGroup

GLOBAL_OPTIONS = "Every command also takes --json, --plain, --quiet (-q) and -C DIR."

_HELP_OPTIONS = {"help_option_names": ["-h", "--help"]}

LEARN = "Learn"
WORK = "Work on an exercise"
KEEP = "Keep and hand in"
TEACH = "Instructors"


@dataclass(frozen=True, slots=True)
class Entry:
    """One command.

    Attributes:
        module, name: where it is: a function, or ``app``, a group of commands.
        panel: the heading it is listed under.
        summary: one line for lists.
        example: a line to copy.
    """

    module: str
    name: str
    panel: str
    summary: str
    example: str

    @property
    def is_group(self) -> bool:
        return self.name == "app"


COMMANDS: dict[str, Entry] = {
    "demo": Entry("setup.demo", "demo", LEARN, "Find and fix a mistake, without a workspace.", "course demo"),
    "init": Entry("setup.making", "init", LEARN, "Make a workspace.", "course init my-course"),
    "lessons": Entry("reading.commands", "lessons", LEARN, "List the lessons.", "course lessons"),
    "lesson": Entry(
        "reading.commands", "lesson", LEARN, "Read a lesson.", "course lesson numerical-integration"
    ),
    "warmup": Entry(
        "reading.commands", "warmup", LEARN, "Do a lesson's small tasks.", "course warmup fall-time"
    ),
    "exercises": Entry("home.overview", "exercises", LEARN, "List the exercises.", "course exercises"),
    "next": Entry("home.going", "next_command", LEARN, "Say what is next.", "course next"),
    "go": Entry("home.going", "go", LEARN, "Go on from where you stopped.", "course go"),
    "quiz": Entry(
        "quiz.commands", "app", LEARN, "Answer the quiz, and review what was missed.", "course quiz take"
    ),
    "sim": Entry(
        "sim", "app", LEARN, "Run a simulation and compare with theory.", "course sim run free-fall"
    ),
    "sandbox": Entry(
        "sandbox.commands",
        "app",
        LEARN,
        "Play with collisions, and see where the energy goes.",
        "course sandbox play newtons-cradle",
    ),
    "engines": Entry(
        "engines.commands",
        "app",
        LEARN,
        "Compare real physics engines on this machine.",
        "course engines compare --quick",
    ),
    "notebook": Entry(
        "notebook",
        "app",
        LEARN,
        "Get lessons and exercises as Jupyter notebooks.",
        "course notebook build integrators",
    ),
    "open": Entry(
        "notebook",
        "open_notebook",
        LEARN,
        "Open a notebook in JupyterLab.",
        "course open integrators",
    ),
    "start": Entry(
        "work.changing", "start", WORK, "Put an exercise into the workspace.", "course start integrators"
    ),
    "check": Entry("work.checking", "check", WORK, "Run the public checks.", "course check integrators"),
    "watch": Entry("work.watching", "watch", WORK, "Check again on every save.", "course watch integrators"),
    "hint": Entry("work.hinting", "hint", WORK, "Show the next hint.", "course hint integrators"),
    "diff": Entry(
        "work.changing", "diff", WORK, "Show what changed since the stub.", "course diff integrators"
    ),
    "report": Entry(
        "work.reporting",
        "report",
        WORK,
        "Show what your code does, with figures.",
        "course report sim-to-real",
    ),
    "reflect": Entry(
        "work.hinting",
        "reflect",
        WORK,
        "Answer in prose, and grade your answer.",
        "course reflect sim-to-real",
    ),
    "solution": Entry(
        "work.hinting",
        "solution",
        WORK,
        "Show a released solution, after a pass.",
        "course solution integrators",
    ),
    "reset": Entry(
        "work.changing", "reset", KEEP, "Go back to the stub; a copy is kept.", "course reset integrators"
    ),
    "update": Entry(
        "work.changing", "update", KEEP, "Bring newer course content in.", "course update --dry-run"
    ),
    "progress": Entry("home.overview", "progress", KEEP, "Show everything done so far.", "course progress"),
    "submit": Entry(
        "work.submitting", "submit", KEEP, "Write the file to hand in.", "course submit -o mine.zip"
    ),
    "doctor": Entry("setup.doctor", "doctor", KEEP, "Say what works on this machine.", "course doctor"),
    "bug": Entry("setup.doctor", "bug", KEEP, "Write what a fault report needs into a file.", "course bug"),
    "schema": Entry(
        "frame.schemas", "schema", KEEP, "Print the JSON Schema of a reply.", "course schema check"
    ),
    "grade": Entry(
        "grade.commands", "app", TEACH, "Grade a class.", "course grade run submissions --out grades"
    ),
    "author": Entry(
        "author.commands", "app", TEACH, "Write and check the course itself.", "course author check"
    ),
}


#: The command behind ``course`` alone: a module and its function.
HOME = "home.overview", "dashboard"


class LazyGroup(TyperGroup):
    """A group that knows its commands by name and loads the one that is run."""

    def list_commands(self, ctx: Any) -> list[str]:  # noqa: ARG002 - the signature is typer's
        """Names in the order they are listed."""
        return list(COMMANDS)

    def get_command(self, ctx: Any, cmd_name: str) -> Any:  # noqa: ARG002 - the signature is typer's
        """A stand-in with the name and the summary, which is all that a list needs."""
        entry = COMMANDS.get(cmd_name)
        if entry is None:
            return None
        return TyperCommand(
            name=cmd_name,
            help=entry.summary,
            rich_help_panel=entry.panel,
            rich_markup_mode=self.rich_markup_mode,
        )

    def resolve_command(self, ctx: Any, args: list[str]) -> Any:
        """The real command, for the one that is run or completed."""
        self.commands = cast("Any", dict.fromkeys(COMMANDS))  # only the names, for "did you mean"
        name, command, rest = super().resolve_command(ctx, args)
        if command is not None and name is not None:
            command = _load(name, COMMANDS[name], self.rich_markup_mode)
        return name, command, rest


def build(group: type[TyperGroup], *, fancy: bool) -> typer.Typer:
    """The empty program: its commands come from ``COMMANDS``."""
    return typer.Typer(
        name="course",
        cls=group,
        invoke_without_command=True,
        rich_markup_mode="rich" if fancy else None,
        pretty_exceptions_enable=False,
        context_settings=_HELP_OPTIONS,
    )


def group_of(help: str, group: type[TyperGroup] | None = None) -> typer.Typer:  # noqa: A002 - typer's name
    """A group of commands that shows its help where none of them is named.

    Args:
        group: one that does something else then.
    """
    return typer.Typer(
        cls=group,
        help=help,
        no_args_is_help=group is None,
        invoke_without_command=group is not None,
        pretty_exceptions_enable=False,
        context_settings=_HELP_OPTIONS,
    )


def find(module: str, name: str) -> Any:
    """A function of a room, which is imported now."""
    return getattr(importlib.import_module(f"course.cli.{module}"), name)


def _load(name: str, entry: Entry, mode: Any) -> Any:
    """Import a command and hand it to typer."""
    target = find(entry.module, entry.name)
    if entry.is_group:
        target.info.name = name
        target.rich_markup_mode = mode
        return typer.main.get_group(target)
    app = typer.Typer(
        add_completion=False,
        rich_markup_mode=mode,
        pretty_exceptions_enable=False,
        context_settings=_HELP_OPTIONS,
    )
    app.command(name, epilog=f"Example: {entry.example}\n\n{GLOBAL_OPTIONS}")(target)
    return typer.main.get_command(app)
