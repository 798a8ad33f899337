"""The options of ``course grade`` that need more than a line, or that several commands take."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from course.cli.frame.completion import choice_of, exercise_ids, run_numbers
from course.errors import UsageError
from course.grading.intake.downloads import LAYOUTS

__all__ = [
    "Against", "Exercises", "Isolation", "Jobs", "Layout", "LocalCluster", "Missing", "Out", "Protection",
    "Reason", "RosterFile", "Scheduler", "Share", "levels", "one_of",
]  # fmt: skip

_LEVELS = {"auto": (None, "L2"), "strict": ("L3", "L3"), "process": ("L1", "L1")}


def levels(isolation: str) -> tuple[str | None, str]:
    """The level to insist on, if any, and the weakest one to accept."""
    if isolation not in _LEVELS:
        raise UsageError(f"--isolation is {isolation!r}.", help="It takes auto, strict or process.")
    return _LEVELS[isolation]


def one_of(name: str, *values: str, help: str | None = None) -> Any:  # noqa: A002 - the option's name
    """An option that takes one of these values, which the shell completes."""
    return typer.Option(name, metavar="|".join(values), autocompletion=choice_of(*values), help=help)


def _share(text: str | float) -> float:
    """A part of a whole, as 0.6 or as 60%."""
    number, percent, rest = str(text).strip().partition("%")
    try:
        share = float(number) / (100 if percent else 1)
    except ValueError:
        share = -1.0
    if rest or not 0 <= share <= 1:
        raise UsageError(
            f"--share is {text!r}.", help="It takes a number from 0 to 1, or a percentage: 0.6 or 60%."
        )
    return share


Against = Annotated[
    str,
    typer.Option(
        "--against",
        metavar="RUN|SNAPSHOT",
        help="Use the graders of that run; `log` lists them.",
        autocompletion=run_numbers,
    ),
]
Exercises = Annotated[
    list[str] | None,
    typer.Option("--exercise", metavar="ID", help="These only.", autocompletion=exercise_ids),
]
Isolation = Annotated[str, one_of("--isolation", *_LEVELS, help="As for `course grade run`.")]
Jobs = Annotated[int, typer.Option("-j", min=1, max=256, help="Grader processes.")]
Layout = Annotated[
    str,
    one_of(
        "--layout",
        *LAYOUTS,
        help="The kind of folder; auto finds out, and refuses a folder that fits two kinds.",
    ),
]
LocalCluster = Annotated[
    int | None,
    typer.Option("--local-cluster", metavar="N", min=1, max=256, help="On N Dask workers started here."),
]
Missing = Annotated[
    str, one_of("--missing", "blank", "zero", help="What an enrolled student who handed in nothing gets.")
]
Out = Annotated[Path, typer.Argument(metavar="OUT", help="Folder of a grading run.")]
Protection = Annotated[
    str,
    one_of(
        "--isolation",
        *_LEVELS,
        help="auto: the best level, L2 at least. strict: L3. process: L1, which does not protect your files.",
    ),
]
Reason = Annotated[str, typer.Option("--reason", metavar="TEXT", help="Kept with the change.")]
RosterFile = Annotated[
    Path | None,
    typer.Option(
        "--roster",
        metavar="FILE",
        help="Who is enrolled: an export from Canvas, Moodle or Gradescope, or your own CSV.",
    ),
]
Scheduler = Annotated[
    str | None,
    typer.Option("--scheduler", metavar="ADDRESS", help="On the Dask cluster whose scheduler is there."),
]
Share = Annotated[
    float,
    typer.Option(
        "--share",
        metavar="SHARE",
        parser=_share,
        help="Show pairs with at least this much in common, such as 0.6 or 60%.",
    ),
]
