"""The reader driven without a terminal: opened, read off its screen, and left."""

import asyncio
from collections.abc import Awaitable, Callable
from pathlib import Path
from typing import Any

import pytest

from course.catalog.load import Catalog
from course.cli.reading.screen.app import ReaderApp
from course.progress.workspace import Workspace

CATALOG = Catalog()


@pytest.fixture
def mine(tmp_path: Path) -> Workspace:
    """A workspace of the course itself."""
    return Workspace.create(tmp_path / "mine", CATALOG.course_id, CATALOG.version)


def drive(
    app: ReaderApp, journey: Callable[[ReaderApp, Any], Awaitable[None]], size: tuple[int, int] = (80, 24)
) -> None:
    """Open the reader, wait for its lesson, do what ``journey`` does, leave."""

    async def driven() -> None:
        async with app.run_test(size=size) as pilot:
            await settled(app, pilot)
            await journey(app, pilot)

    try:
        asyncio.run(driven())
    finally:
        app.page.close()


async def settled(app: ReaderApp, pilot: Any) -> None:
    for _ in range(200):
        await pilot.pause(0.02)
        if app.page.book is not None and app.page.book.whole:
            return
    pytest.fail("the lesson was never laid out")


def screen(app: ReaderApp) -> str:
    height = app.size.height
    return "\n".join("".join(s.text for s in app.page.render_line(y)).rstrip() for y in range(height))
