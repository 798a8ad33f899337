"""The global options, which may stand anywhere on the line, and how a command declares its own.

Parsers of sub-commands know only their own options, so these are taken out of the arguments first. ``--``
ends the search: what follows it is data.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import typer

from course.cli.frame.console import Settings

_FLAGS = {"--json": "json", "--plain": "plain", "--quiet": "quiet", "-q": "quiet", "--version": "version"}


@dataclass(frozen=True, slots=True)
class Line:
    """A command line taken apart.

    Attributes:
        rest: everything else, in order.
        version: ``--version`` was given.
        problem: what is wrong with the global options; empty if nothing is. It is reported later, by the
            one place that reports, in the shape the other options ask for.
    """

    settings: Settings
    rest: tuple[str, ...]
    version: bool = False
    problem: str = ""


def global_options(arguments: Sequence[str]) -> Line:
    found: set[str] = set()
    directory: str | None = None
    rest: list[str] = []
    problem = ""
    position = 0
    while position < len(arguments):
        word = arguments[position]
        position += 1
        if word == "--":
            rest += [word, *arguments[position:]]
            break
        if word in _FLAGS:
            found.add(_FLAGS[word])
        elif word == "-C":
            if position == len(arguments):
                problem = "-C needs the folder to work in."
                break
            directory = _below(directory, arguments[position])
            position += 1
        elif word.startswith("-C"):
            directory = _below(directory, word.removeprefix("-C"))
        else:
            rest.append(word)
    settings = Settings(
        json="json" in found, plain="plain" in found, quiet="quiet" in found, directory=directory
    )
    return Line(settings=settings, rest=tuple(rest), version="version" in found, problem=problem)


def _below(first: str | None, second: str) -> str:
    """Two ``-C`` in a row add up, the second below the first."""
    return second if first is None else str(Path(first) / second)


# ---
# How a command declares its arguments and options.


def argument(value: str, help: str | None = None, complete: Any = None) -> Any:  # noqa: A002 - typer's name
    """An argument: what its value is called, what it is, and what the shell offers."""
    return typer.Argument(metavar=value, help=help, autocompletion=complete)


def option(names: str, help: str | None = None, complete: Any = None, **limits: Any) -> Any:  # noqa: A002
    """An option: its names and what its value is called, as in "-o --output FILE"; the rest as above.

    Args:
        limits: what else typer knows of a value, such as the least that it may be.
    """
    named = [word for word in names.split() if word.startswith("-")]
    value = " ".join(names.split()[len(named) :]) or None
    return typer.Option(*named, metavar=value, help=help, autocompletion=complete, **limits)
