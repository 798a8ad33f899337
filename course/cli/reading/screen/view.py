"""Opening the full-screen reader."""

from __future__ import annotations

import os
import sys

from course.catalog.load import Catalog
from course.errors import CourseError
from course.progress.store import Event
from course.progress.workspace import Workspace
from course.reading.record import InProgress, Writer


def is_possible() -> bool:
    """Whether this terminal can be drawn on: a user is there, and non-ASCII letters are shown."""
    if os.environ.get("TERM", "") in {"", "dumb", "unknown"}:
        return False
    if not (sys.stdin and sys.stdin.isatty() and sys.stdout and sys.stdout.isatty()):
        return False
    return (sys.stdout.encoding or "").lower().replace("-", "") == "utf8"


def read(
    catalog: Catalog, first: str, workspace: Workspace | None, section: str = ""
) -> tuple[InProgress, str]:
    """Read until the reader leaves. The terminal is restored, whatever happens.

    Args:
        catalog: the course.
        first: id of the lesson to open.
        workspace: the student's; None outside of one.
        section: slug of the section to open it at; where it was left if empty.

    Returns:
        The lesson that was open last, and why something was not recorded ("" if all was).
    """
    from course.cli.reading.screen.app import ReaderApp
    from course.cli.reading.screen.drawing import Drawer
    from course.cli.reading.screen.practice import Practice

    store = workspace.store if workspace is not None else None
    writer = Writer(store)
    troubles: list[str] = []

    def events(lesson: str) -> tuple[Event, ...]:
        if store is None:
            return ()
        try:
            return store.events(subject=lesson)
        except CourseError as error:
            troubles.append(f"{error.message} {error.help}")
            return ()

    practice = Practice(catalog, workspace)
    app = ReaderApp(
        catalog, first, section, events=events, write=writer, pictures=Drawer(), practice=practice
    )
    try:
        app.play()
    finally:
        practice.close()
        writer.close()
    return app.progress, writer.trouble or "".join(troubles[:1])
