"""The reader driven without a terminal: opened, read off its screen, and left."""

import asyncio
import contextlib
import inspect
import signal
from collections.abc import AsyncIterator, Callable
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


@pytest.hookimpl(tryfirst=True)
def pytest_pyfunc_call(pyfuncitem: pytest.Function) -> bool | None:
    """A test may be a coroutine: whoever drives the reader waits for it."""
    if not inspect.iscoroutinefunction(pyfuncitem.obj):
        return None
    given = inspect.signature(pyfuncitem.obj).parameters
    asyncio.run(pyfuncitem.obj(**{name: pyfuncitem.funcargs[name] for name in given}))
    return True


@contextlib.asynccontextmanager
async def opened(app: ReaderApp, size: tuple[int, int] = (80, 24)) -> AsyncIterator[Any]:
    """The reader with its lesson laid out, for who presses its keys; behind it everything is written."""
    try:
        async with app.run_test(size=size) as pilot:
            await settled(app, pilot)
            yield pilot
    finally:
        await asyncio.to_thread(app.page.close)


async def settled(app: ReaderApp, pilot: Any, *keys: str) -> None:
    """The lesson is laid out, after these keys."""
    await pilot.press(*keys)
    await until(pilot, lambda: app.page.book is not None and app.page.book.whole)


async def until(pilot: Any, done: Callable[[], bool]) -> None:
    """Wait until it is so; a busy machine needs a while."""
    for _ in range(3000):
        await pilot.pause(0.02)
        if done():
            return
    pytest.fail("It never came to that.")


async def at_block(app: ReaderApp, pilot: Any, index: int) -> None:
    """Where a block is at hand."""
    app._chosen(f"block:{index}")
    await pilot.pause()


async def leave(pilot: Any, how: str) -> None:
    """By a key or by a signal."""
    if how.startswith("SIG"):
        signal.raise_signal(getattr(signal, how))
    else:
        await pilot.press(how)
    await pilot.pause(0.2)


async def press(pilot: Any, *keys: str, wait: float | None = None) -> None:
    """Press keys and let the reader answer; a box and a file take a moment."""
    await pilot.press(*keys)
    await pilot.pause(wait)


def screen(app: ReaderApp) -> str:
    height = app.size.height
    return "\n".join("".join(s.text for s in app.page.render_line(y)).rstrip() for y in range(height))
