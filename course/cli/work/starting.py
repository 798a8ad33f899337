"""``course start``: an exercise in the workspace. Nothing is overwritten."""

from __future__ import annotations

from typing import TYPE_CHECKING

from course.cli.frame.arguments import OneExercise  # noqa: TC001 - typer reads annotations at run time
from course.cli.frame.here import Here
from course.cli.frame.replies import FileReply, NextStep
from course.cli.frame.terminal.console import Console, current
from course.cli.work.replies import Start

if TYPE_CHECKING:
    from course.catalog.models import Exercise

__all__ = ["put", "start"]


#: How fast technical text is read. Brysbaert's mean for non-fiction is 238 (J. Mem. Lang. 109, 2019).
_WORDS_A_MINUTE = 200
#: Minutes from which on the length is told.
_LONG = 3


def start(exercise: OneExercise) -> int:
    """Put an exercise into the workspace.

    You get the stub to fill in and its README. An existing file is not changed.
    """

    console, here = current(), Here.load()
    chosen = here.exercise(exercise)
    files = put(console, here, chosen)
    step = f"course watch {chosen.id}"
    minutes = max(1, round(len(chosen.readme_path.read_text(encoding="utf-8").split()) / _WORDS_A_MINUTE))
    console.note(f"Read {chosen.place}/README.md, write your code in {chosen.place}/{chosen.module}.")
    if minutes > _LONG:
        console.note(f"It takes {minutes} minutes to read; you can begin after the first function's section.")
    if not console.led:
        console.note(f"Then check it on every save: {step}")
        console.note(f"Or once, now and then: course check {chosen.id}")
    for warning in here.warnings:
        console.warn(warning)
    console.emit(Start(exercise=chosen.id, files=files, next=NextStep(step)))
    return 0


def put(console: Console, here: Here, chosen: Exercise) -> tuple[FileReply, ...]:
    """Put the files of an exercise into the workspace where they are not there yet, and say so."""
    files = []
    for source in chosen.given:
        target = here.workspace.path(chosen.place, source.name)
        new = here.workspace.give(chosen.place, source.name, source.read_bytes())
        files.append(FileReply(path=str(target), action="created" if new else "kept"))
        verb = "created" if new else "exists already and was not changed"
        console.line(f"{here.workspace.shown(target)} {verb}.")
    here.record("start", chosen.id, {"version": here.catalog.version})
    return tuple(files)
