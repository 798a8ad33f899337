"""Shows the progress of long work, and about how long the rest will take."""

from __future__ import annotations

import contextlib
import time
from typing import TYPE_CHECKING

from course.cli.frame.terminal.console import PATIENCE, Console

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

__all__ = ["meter"]


@contextlib.contextmanager
def meter(console: Console) -> Iterator[Callable[[int, int, str], None]]:
    """A function to call with steps done, steps in all, and what is being done now.

    A terminal shows a bar with an estimate once the work has taken half a second, and removes it at the end.
    Elsewhere, after the same patience, a line is written whenever the work turns to something new: the part
    of its name before a colon.
    """
    if console.quiet:
        yield lambda _done, _total, _what: None
    elif console.fancy:
        with _bar(console) as step:
            yield step
    else:
        seen: set[str] = set()
        started = time.monotonic()

        def say(done: int, total: int, what: str) -> None:
            topic = what.partition(":")[0]
            if what and topic not in seen and time.monotonic() - started > PATIENCE:
                seen.add(topic)
                console.note(f"Working on {topic}: {done} of {total} steps done.")

        yield say


@contextlib.contextmanager
def _bar(console: Console) -> Iterator[Callable[[int, int, str], None]]:
    from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn

    started = time.monotonic()
    columns = (BarColumn(bar_width=20), TextColumn("{task.completed}/{task.total}"), TimeRemainingColumn())
    progress = Progress(*columns, TextColumn("{task.description}"), console=console.rich(), transient=True)
    task = progress.add_task("", total=None)

    def step(done: int, total: int, what: str) -> None:
        if not progress.live.is_started and time.monotonic() - started > PATIENCE:
            progress.start()
        progress.update(task, completed=done, total=total, description=what)

    try:
        yield step
    finally:
        progress.stop()
