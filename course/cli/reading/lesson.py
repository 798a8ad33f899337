"""A lesson on a terminal: laid out for the screen, or line by line for a screen reader.

A page ends where a section ends, and after each prediction, since the figure that answers it must not be in
sight; and after each answer, which is compared with what was predicted.
"""

from __future__ import annotations

import os
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from course.catalog import blocks as b
from course.catalog.markdown import read_task
from course.cli.reading.fancy import FancyPrinter
from course.cli.reading.plain import PlainPrinter
from course.reading.parts import read_script

if TYPE_CHECKING:
    from pathlib import Path

    from rich.console import Console

    from course.catalog.load import Catalog
    from course.catalog.models import Exercise, Lesson
    from course.reading.parts import Section

__all__ = ["Page", "Reader", "paginate"]


@dataclass(frozen=True, slots=True)
class Page:
    """One screenful of reading: a section, or a section up to a prediction.

    Attributes:
        section: the heading it is under; empty before the first.
        blocks: what it shows, the heading included where the section starts here.
        first: the lesson's title, summary and objectives come before it.
    """

    section: str
    blocks: tuple[b.Block, ...]
    first: bool = False


class Reader:
    """A lesson being read on one console.

    Args:
        catalog: names what the lesson links to.
        lesson: the one to show.
        console: where to print.
        plain: one fact a line, no boxes, formulae in words, figures and diagrams as their descriptions.
        figures_dir: folder to write the figures to as PNG; None writes none.
        width: columns to use; the console's own if left out.
        wraps: plain lines wrap between words.

    Raises:
        ContentError: the lesson cannot be read or parsed.
        UsageError: the folder for figures cannot be written to.

    Attributes:
        script: the lesson with its warm-ups in their places.
        pages: all of its pages, in reading order.
    """

    def __init__(
        self,
        catalog: Catalog,
        lesson: Lesson,
        console: Console,
        *,
        plain: bool = False,
        figures_dir: Path | None = None,
        width: int | None = None,
        wraps: bool = False,
    ) -> None:
        self._lesson = lesson
        self.script = read_script(lesson, catalog.warm_ups(lesson.id))
        self.pages = paginate(self.script.blocks)
        everything = b.walk_blocks(self.script.blocks)
        numbers = [block.id for block in everything if isinstance(block, b.Figure)]
        self._printer: FancyPrinter | PlainPrinter
        # A terminal that cannot show the drawings and formulae gets what a screen reader gets.
        if plain or not console.encoding.lower().startswith("utf"):
            self._printer = PlainPrinter(catalog, lesson, console, numbers, figures_dir, wraps)
        else:
            self._printer = FancyPrinter(
                catalog, lesson, console, numbers, figures_dir, width or console.width, os.environ
            )

    @property
    def pictures(self) -> tuple[Path, ...]:
        """The pictures written so far."""
        return tuple(self._printer.pictures)

    def show(self, page: Page) -> None:
        """Print one page."""
        if page.first:
            self._printer.head()
        self._printer.blocks(page.blocks)

    def show_section(self, section: Section) -> bool:
        """Print one section of the lesson; returns False, because that is not the whole lesson."""
        self._printer.blocks(self.script.blocks[section.start : section.end])
        return False

    def show_task(self, warm_up: Exercise) -> None:
        """Print the text of a warm-up of the lesson."""
        self._printer.blocks(read_task(warm_up.readme_path))


def paginate(blocks: tuple[b.Block, ...]) -> tuple[Page, ...]:
    """Blocks as pages; a task has one of its own, and none shows nothing."""
    pages: list[Page] = []
    section, current = "", []  # type: str, list[b.Block]
    for block in blocks:
        begins = isinstance(block, b.Task) or (isinstance(block, b.Heading) and block.level == 2)
        if (begins or (current and _ends_page(current[-1]))) and not all(map(_unseen, current)):
            pages.append(Page(section, tuple(current), first=not pages))
            current = []
        if isinstance(block, b.Heading) and block.level == 2:
            section = b.plain_text(block.inlines)
        current.append(block)
    if pages and all(map(_unseen, current)):
        pages[-1] = replace(pages[-1], blocks=(*pages[-1].blocks, *current))
    elif current:
        pages.append(Page(section, tuple(current), first=not pages))
    return tuple(pages)


def _ends_page(block: b.Block) -> bool:
    answers = isinstance(block, b.Callout) and block.kind == "answer"
    return answers or isinstance(block, b.Prediction | b.Task)


def _unseen(block: b.Block) -> bool:
    return isinstance(block, b.CodeCell) and block.hidden
