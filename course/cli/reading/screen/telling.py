"""The words around the lesson: keys, contents, the place, the next step."""

from __future__ import annotations

from collections.abc import Callable

from rich.console import Group
from rich.table import Table
from rich.text import Text

from course.catalog.blocks import Task
from course.catalog.load import Catalog
from course.cli.reading.screen.practice import Practice
from course.cli.reading.screen.printing import BlockRows, ScreenPrinter
from course.reading.parts import Script
from course.reading.record import InProgress, Layout

_SHORT_OF = "…"
_BETWEEN, _ALL_KEYS = "   ", "? keys"

_HELP = (
    ("Space, PgDn", "next screen; at the end of the lesson: what is next"),
    ("b, PgUp", "the screen before"),
    ("↓ ↑, j k, the wheel", "a line on or back"),
    ("g G, Home End", "the first screen, the last"),
    ("Tab, Shift-Tab", "the next thing that keys act on: a prediction, a cell, a figure, a link"),
    ("Enter", "predict; run the cell; start or check the task; open the figure; follow the link"),
    ("s", "skip a prediction; that is kept, too"),
    ("1 2 3", "below an answer: you were right, nearly right, wrong"),
    ("r", "run the cell, and before it what it needs; check the warm-up or the exercise"),
    ("Ctrl-C", "stop the cell that runs; else leave. Your place is kept"),
    ("e", "change the cell or the task's file; Ctrl-R there runs or checks it"),
    ("h", "at a task its next hint; elsewhere these keys"),
    ("u", "put the lesson's own code back into the cell"),
    ("c", "copy the cell, or a command, to the clipboard of your terminal"),
    ("w", "write the cell into a file here"),
    ("o", "open the figure in the system's viewer"),
    ("t", "contents, with what is done"),
    ("/", "search in this lesson and in all"),
    ("n", "the next place that the search finds"),
    ("Backspace", "back to where a link was followed"),
    ("q", "leave; `course lesson` comes back to this line"),
)


def keys_table(width: int) -> Table:
    """All keys, on a screen of this many columns."""
    grid = Table.grid(padding=(0, 2, 0, 0))
    grid.add_column(no_wrap=width >= 60)
    grid.add_column()
    for key, what in _HELP:
        grid.add_row(Text(key, style="bold"), Text(what))
    return grid


def contents(
    catalog: Catalog, progress: InProgress, here: int, is_read: Callable[[str], bool], practice: Practice
) -> tuple[list[tuple[str, str]], str]:
    """The sections of a lesson, and the other lessons, with what is done.

    Args:
        here: index of the block at the top of the screen.
        is_read: whether a lesson was read.
        practice: how far the student is with warm-ups and exercises.

    Returns:
        (key, what to show) of each, and the key of where the reader is.
    """
    script, options, at = progress.script, list[tuple[str, str]](), ""
    for section in script.sections:
        done = progress.is_done(section.start, section.end)
        asked = [q for q in script.questions if section.start <= q.index < section.end]
        open_ = sum(progress.prediction(q) is None for q in asked)
        more = f"   {open_} to predict" if open_ and section.level == 2 else ""
        indent = "  " * (section.level - 2)
        options.append((f"block:{section.start}", f"{'✓' if done else ' '} {indent}{section.title}{more}"))
        if section.start <= here and section.level == 2:
            at = f"block:{section.start}"
        for index, block in enumerate(script.blocks):
            if isinstance(block, Task) and script.section_at(index) == section:
                mark = "✓" if practice.of(block.id).done else " "
                options.append((f"block:{index}", f"{mark}   {block.what.partition(',')[0]}: {block.title}"))
    options.append(("", ""))
    for number, name in enumerate(catalog.lesson_ids(), start=1):
        words = f"{'✓' if is_read(name) else ' '} {number}. {catalog.lesson(name).title}"
        options.append((f"lesson:{name}", words))
    return options, at


def position(script: Script, layout: Layout, top: int, end: int) -> str:
    """Which screen of how many, and the minutes left.

    Args:
        top, end: the first row on the screen, and the one after the last.
    """
    last = layout.rows[end - 1].block if end else 0
    at_end = end >= len(layout)
    left = "the end" if at_end else f"{max(1, round(script.minutes_left(last + 1)))} min left"
    number = len(layout.starts) if at_end else layout.number(top)
    return f"{number} of {len(layout.starts)} · {left}"


def tail(printer: ScreenPrinter, catalog: Catalog, progress: InProgress, practice: Practice) -> BlockRows:
    """The rows after the last line: the lesson is read, and the next step."""
    script = progress.script
    lesson, ids = script.lesson, catalog.lesson_ids()
    following = ids[ids.index(lesson.id) + 1 :][:1] if lesson.id in ids else ()
    words = [(f"exercise:{name}", f"Practise: {name}") for name in lesson.exercises]
    words += [(f"lesson:{name}", f"Next lesson: {catalog.lesson(name).title}") for name in following]
    shown = [Text("─" * 20, style="dim"), Text("You have read this lesson.", style="bold")]
    count = sum(progress.prediction(q) is None for q in script.questions)
    if count:
        shown.append(Text(f"{count} prediction{'s are' if count != 1 else ' is'} still open: t shows where."))
    tasks = [block for block in script.blocks if isinstance(block, Task) and block.what != "exercise"]
    left = sum(not practice.of(task.id).done for task in tasks) if practice.possible else 0
    if left:
        shown.append(Text(f"{left} warm-up{'s are' if left != 1 else ' is'} left: t shows where."))
    return printer.tail_rows(Group(*shown, Text("")), words, len(script.blocks))


def fitting(keys: str, width: int) -> str:
    """The keys that fit: of a line that is too long, the first ones, and how to see all.

    Args:
        keys: each with what it does, three blanks between them.
    """
    parts = keys.split(_BETWEEN)
    if len(keys) <= width or len(parts) == 1:
        return shortened(keys, width)
    kept = [part for part in parts if part != _ALL_KEYS]
    while len(kept) > 1 and len(_BETWEEN.join((*kept, _ALL_KEYS))) > width:
        kept.pop()
    whole = _BETWEEN.join((*kept, _ALL_KEYS))
    return whole if len(whole) <= width else shortened(kept[0], width)


def shortened(text: str, width: int) -> str:
    """As much of a text as fits, with a sign where it was cut."""
    return text if len(text) <= width else text[: max(1, width - 1)].rstrip() + _SHORT_OF
