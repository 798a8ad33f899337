"""``course warmup``: lists the lessons' small tasks, starts one, checks one."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

from course.cli.frame.arguments import WarmUpName  # noqa: TC001 - typer reads annotations at run time
from course.cli.frame.here import Here, find_workspace, load_catalog
from course.cli.frame.replies import NextStep
from course.cli.frame.terminal.console import Console, current
from course.cli.home.overview import warm_up_state, warm_up_states
from course.cli.reading.replies import WarmUps
from course.cli.work.checking import check as check_work
from course.cli.work.replies import Start
from course.cli.work.starting import put
from course.errors import CourseError, NotFoundError, UsageError

if TYPE_CHECKING:
    from course.catalog.load import Catalog
    from course.catalog.models import Exercise
    from course.cli.home.replies import WarmUpState

__all__ = ["warmup"]

_MARKS = {"done": "✓", "started": "·", "new": " "}
_PLAIN_MARKS = {"done": "done", "started": "begun", "new": "to do"}


def warmup(
    name: WarmUpName = None,
    check: Annotated[bool, typer.Option("--check", help="Check it, as `course check` does.")] = False,
) -> int:
    """Do a lesson's small tasks.

    Without an id: all of them by lesson, with what is done. With one: its text, and the file to work in. Five
    minutes each, checked and explained as exercises are; they count for nothing.
    """
    console = current()
    if name is None:
        if check:
            raise UsageError("--check needs the id of a warm-up.", help="`course warmup` lists them.")
        return _list(console)
    here = Here.load()
    chosen = _warm_up(here.catalog, name)
    return check_work(chosen.id) if check else _begin(console, here, chosen)


def _warm_up(catalog: Catalog, name: str) -> Exercise:
    """The warm-up of that id.

    Raises:
        NotFoundError: there is none of that id, or it is an exercise.
    """
    chosen = catalog.exercise(name.rstrip("/\\"))
    if not chosen.is_warm_up:
        raise NotFoundError(
            f"{chosen.id} is an exercise, not a warm-up.",
            help=f"`course start {chosen.id}` puts it into the workspace.",
            code="not_a_warm_up",
        )
    return chosen


def _list(console: Console) -> int:
    here = find_workspace()
    catalog = here.catalog if here else load_catalog()
    states: tuple[WarmUpState, ...]
    try:
        states = warm_up_states(here) if here else tuple(map(warm_up_state, catalog.warm_ups()))
    except CourseError as error:
        console.warn(f"{error.message} {error.help}")
        states = tuple(map(warm_up_state, catalog.warm_ups()))
    if not states:
        console.line("This course has no warm-ups.")
    marks = _MARKS if console.fancy else _PLAIN_MARKS
    with console.paged():
        for lesson in catalog.lessons():
            ours = [state for state in states if state.lesson == lesson.id]
            if not ours:
                continue
            done = sum(state.state == "done" for state in ours)
            console.heading(lesson.title.partition(":")[0], f"{done} of {len(ours)} done")
            for state in ours:
                console.item(marks[state.state], f"{state.title} ({state.id}), {state.minutes} min", width=6)
    left = next((state for state in states if state.state != "done"), None)
    step = f"course warmup {left.id}" if left else ""
    if step:
        console.note(f"Next: {step}" if here else f"In a workspace (course init): {step}")
    console.emit(WarmUps(warm_ups=states, next=NextStep(step) if step else None))
    return 0


def _begin(console: Console, here: Here, chosen: Exercise) -> int:
    """Its text, and its file in the workspace."""
    from course.cli.reading.lesson import Reader

    if not console.quiet and not console.json:
        lesson = here.catalog.lesson(chosen.lesson)
        reader = Reader(
            here.catalog,
            lesson,
            console.rich(),
            plain=console.plain,
            width=console.width,
            wraps=console.wraps,
        )
        console.heading(chosen.title, f"{chosen.minutes} minutes")
        reader.show_task(chosen)
        console.blank()
    files = put(console, here, chosen)
    step = f"course check {chosen.id}"
    console.note(
        f"Write in {chosen.place}/{chosen.module} with your own editor, about {chosen.minutes} minutes."
    )
    if not console.led:
        console.note(f"Check it:          {step}")
        console.note(f"On every save:     course watch {chosen.id}")
        console.note(f"Still failing:     course hint {chosen.id}")
    for warning in here.warnings:
        console.warn(warning)
    console.emit(Start(exercise=chosen.id, files=files, next=NextStep(step)))
    return 0
