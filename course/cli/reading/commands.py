"""``course lessons`` and ``course lesson``: what there is to read, and reading it."""

from __future__ import annotations

import io
from pathlib import Path  # noqa: TC003 - typer reads annotations at run time
from typing import TYPE_CHECKING, Annotated

import typer

from course.cli.frame.arguments import LessonName  # noqa: TC001 - typer reads annotations at run time
from course.cli.frame.console import MAX_WIDTH, Console, current
from course.cli.frame.here import find_workspace, load_catalog
from course.cli.frame.replies import LessonReply, Lessons, NextStep
from course.cli.work.overview import day, lesson_state, lesson_states
from course.errors import CourseError, NotFoundError

if TYPE_CHECKING:
    from course.catalog.load import Catalog
    from course.catalog.models import Lesson
    from course.cli.frame.here import Here
    from course.cli.reading.lesson import Reader

__all__ = ["lesson", "lessons"]


def lessons() -> int:
    """List the lessons.

    In the order to read them; inside a workspace also which ones you have read.
    """

    console = current()
    here = find_workspace()
    catalog = here.catalog if here else load_catalog()
    states = lesson_states(here) if here else tuple(lesson_state(item, None) for item in catalog.lessons())
    rows = []
    for state in states:
        read = day(state.read_at)[:10] if state.read_at else "" if here is None else "no"
        rows.append((state.id, state.title, f"{state.minutes} min", read))
    console.table(("Id", "Lesson", "Time", "Read"), rows)
    unread = next((state.id for state in states if state.read_at is None), None)
    step = f"course lesson {unread}" if unread else None
    if step:
        console.note(f"Next: {step}")
    console.emit(Lessons(lessons=states, next=NextStep(step) if step else None))
    return 0


def lesson(
    name: LessonName = None,
    page: Annotated[
        bool, typer.Option("--page", help="A section at a time; goes on where you stopped.")
    ] = False,
    figures: Annotated[
        Path | None, typer.Option("--figures", metavar="DIR", help="Write the figures as PNG files into DIR.")
    ] = None,
) -> int:
    """Read a lesson.

    Without an id: the next one you have not read. Inside a workspace, reading is noted in your progress.
    """

    console = current()
    here = find_workspace()
    catalog = here.catalog if here else load_catalog()
    chosen = catalog.lesson(name or _next_unread(here, catalog))
    text = io.StringIO()
    reader = _reader(catalog, chosen, console, figures, text if console.json else None)
    whole = _read_by_page(console, here, chosen, reader) if page and console.interactive else _read(reader)
    step = _after(chosen) if whole else f"course lesson {chosen.id} --page"
    if here is not None:
        if whole:
            here.record("lesson", chosen.id, {"version": catalog.version})
        for warning in here.warnings:
            console.warn(warning)
    for picture in reader.pictures:
        console.note(f"Wrote {picture}")
    console.note(f"Next: {step}")
    console.emit(
        LessonReply(
            id=chosen.id,
            title=chosen.title,
            minutes=chosen.minutes,
            objectives=chosen.objectives,
            exercises=chosen.exercises,
            text=text.getvalue(),
            figures=tuple(str(path) for path in reader.pictures),
            next=NextStep(step),
        )
    )
    return 0


def _next_unread(here: Here | None, catalog: Catalog) -> str:
    """The first unread lesson; the first of all where nothing is recorded or everything was read."""
    read: set[str] = set()
    if here is not None:
        try:
            read = {event.subject for event in here.workspace.store.events("lesson")}
        except CourseError as error:
            here.warnings.append(f"{error.message} {error.help}")
    ids = catalog.lesson_ids()
    if not ids:
        raise NotFoundError("This course has no lessons.", code="lesson_not_found")
    return next((item for item in ids if item not in read), ids[0])


def _reader(
    catalog: Catalog, chosen: Lesson, console: Console, figures: Path | None, text: io.StringIO | None
) -> Reader:
    """The lesson, ready to be shown on the console, or put into ``text`` as ``--plain`` shows it."""
    from course.cli.reading.lesson import Reader

    if text is None:
        return Reader(
            catalog, chosen, console.rich(), plain=console.plain, figures_dir=figures, width=console.width
        )
    from rich.console import Console as RichConsole

    quiet = RichConsole(file=text, width=MAX_WIDTH, no_color=True, markup=False, emoji=False, highlight=False)
    return Reader(catalog, chosen, quiet, plain=True, figures_dir=figures, width=MAX_WIDTH)


def _read(reader: Reader) -> bool:
    """Show everything."""
    for item in reader.pages:
        reader.show(item)
    return True


def _read_by_page(console: Console, here: Here | None, chosen: Lesson, reader: Reader) -> bool:
    """Show a page at a time, from where the reader stopped last time; False if they stop before the end."""
    total = len(reader.pages)
    first = _place(here, chosen, total)
    if first:
        console.line(f"Going on with page {first + 1} of {total}. Without --page: the whole lesson.")
    for number in range(first, total):
        reader.show(reader.pages[number])
        if number + 1 < total and not console.go_on(f"Page {number + 1} of {total}."):
            if here is not None:
                here.record("place", chosen.id, {"page": number + 1})
            return False
    return True


def _place(here: Here | None, chosen: Lesson, total: int) -> int:
    """The page to go on with: after the last one seen, or the first if the lesson was read since."""
    if here is None:
        return 0
    try:
        events = here.workspace.store.events(subject=chosen.id)
    except CourseError:
        return 0
    last = next((event for event in reversed(events) if event.kind in {"place", "lesson"}), None)
    page = last.data.get("page", 0) if last is not None else 0
    return page if isinstance(page, int) and 0 <= page < total else 0


def _after(chosen: Lesson) -> str:
    return f"course start {chosen.exercises[0]}" if chosen.exercises else "course lessons"
