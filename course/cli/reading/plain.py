"""A lesson for a screen reader or a log: one fact per line, no boxes, no meaning in position or colour.

Formulae are words, a diagram is its description, a table row is one "column: value" line per cell, and a
paragraph has one sentence a line. Lines are never wrapped, because a screen reader does that better; only on
a terminal without layout (TERM=dumb) do words wrap.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from rich.text import Text

from course.catalog import blocks as b
from course.cli.reading.words import LABELS, link_words, value_spoken
from course.figures.registry import save

if TYPE_CHECKING:
    from pathlib import Path

    from rich.console import Console

    from course.catalog.load import Catalog
    from course.catalog.models import Lesson

__all__ = ["PlainPrinter", "sentences"]

# A full stop after a single capital is an initial (E. Hairer), not an end.
_SENTENCE_END = re.compile(r"(?<=[.!?])(?<!\b[A-Z]\.)[\"”)]?\s+(?=[A-Z\"“(\d])")


class PlainPrinter:
    """Prints the parts of one lesson as plain lines."""

    def __init__(
        self,
        catalog: Catalog,
        lesson: Lesson,
        console: Console,
        figure_ids: list[str],
        figures_dir: Path | None,
        wraps: bool = False,
    ) -> None:
        self._catalog = catalog
        self._lesson = lesson
        self._console = console
        self._figure_ids = figure_ids
        self._figures_dir = figures_dir
        self._wraps = wraps
        self.pictures: list[Path] = []
        self._told_how = False  # to save them: said once

    def head(self) -> None:
        """Title, summary, objectives."""
        lesson = self._lesson
        self._say(f"Lesson: {lesson.title}")
        self._say(f"Reading time: about {lesson.minutes} minutes")
        self._say(f"Summary: {lesson.summary}")
        for number, objective in enumerate(lesson.objectives, start=1):
            self._say(f"Objective {number}: {objective}")
        for exercise_id in lesson.exercises:
            self._say(f"Exercise for this lesson: {exercise_id}")

    def blocks(self, blocks: tuple[b.Block, ...]) -> None:
        """Print blocks in order, an empty line between sections."""
        for block in blocks:
            if isinstance(block, b.Heading):
                self._say("")
            self._block(block)

    def _say(self, line: str, *, whole: bool = False) -> None:
        self._console.print(Text(line), soft_wrap=whole or not self._wraps)

    def _block(self, block: b.Block) -> None:  # noqa: C901, PLR0912 - one per kind
        match block:
            case b.Heading(level=level, inlines=inlines):
                self._say(f"{'Section' if level == 2 else 'Part'}: {self._words(inlines)}")
            case b.Paragraph(inlines=inlines):
                self._prose(self._words(inlines))
            case b.ListBlock():
                self._list(block)
            case b.Table():
                self._table(block)
            case b.CodeCell(hidden=False):
                self._code(block)
            case b.Listing(text=text):
                self._verbatim("Text", text)
            case b.MathBlock(spoken=spoken):
                for row in spoken.splitlines():
                    self._prose(f"Formula: {row}", whole=True)
            case b.Diagram(description=description):
                self._say(f"Diagram: {description}")
            case b.Figure():
                self._figure(block)
            case b.Prediction(blocks=inner):
                self._labelled(LABELS["predict"], inner)
            case b.Callout(kind=kind, blocks=inner):
                self._labelled(LABELS[kind], inner)
            case b.CommandList(commands=commands):
                for command in commands:
                    self._say(f"Try: {command.command}")
                    if command.note:
                        self._say(f"What it does: {command.note}")
            case b.Task(id=name, what=what, title=title):
                self._say(f"{what.capitalize()}: {title}")
                self._say(f"Try: course warmup {name}")
            case b.Sources(items=items):
                for number, item in enumerate(items, start=1):
                    self._say(f"Source {number}: {self._words(item)}")
            case _:
                pass

    def _prose(self, text: str, *, whole: bool = False) -> None:
        for line in [text] if whole else sentences(text):
            self._say(line)

    def _labelled(self, label: str, inner: tuple[b.Block, ...]) -> None:
        if inner and isinstance(inner[0], b.Paragraph):
            self._prose(f"{label}: {self._words(inner[0].inlines)}")
            inner = inner[1:]
        else:
            self._say(f"{label}:")
        self.blocks(inner)

    def _list(self, block: b.ListBlock) -> None:
        for number, item in enumerate(block.items, start=block.start or 1):
            label = "Item" if block.start is None else f"Step {number}"
            self._labelled(label, item)

    def _table(self, table: b.Table) -> None:
        names = [self._words(cell) for cell in table.header]
        self._say(f"Table, {len(table.rows)} rows of {', '.join(names)}")
        for number, row in enumerate(table.rows, start=1):
            self._say(f"Row {number}")
            for name, cell in zip(names, row, strict=True):
                self._say(f"{name}: {self._words(cell)}")
        self._say("End of table")

    def _code(self, cell: b.CodeCell) -> None:
        self._verbatim("Python code", cell.source)
        if cell.output is not None:
            self._verbatim("It prints", cell.output)

    def _verbatim(self, label: str, text: str) -> None:
        rows = text.splitlines()
        self._say(f"{label}, {len(rows)} line{'s' if len(rows) != 1 else ''}:")
        for row in rows:
            self._say(row, whole=True)
        self._say(f"End of {'output' if label == 'It prints' else label.lower()}")

    def _figure(self, figure: b.Figure) -> None:
        number = self._figure_ids.index(figure.id) + 1
        self._prose(f"Figure {number}: {self._words(figure.caption)}")
        self._prose(f"The figure shows: {figure.alt}")
        if self._figures_dir is None:
            if not self._told_how:
                self._say(f"To save the pictures: course lesson {self._lesson.id} --figures DIR")
            self._told_how = True
            return

        path = save(figure.id, self._figures_dir)
        self.pictures.append(path)
        self._say(f"Picture: {path}")

    def _words(self, inlines: b.Inlines) -> str:
        parts = []
        for inline in inlines:
            match inline:
                case b.Text(text):
                    parts.append(text)
                case b.Value(text=text):
                    parts.append(value_spoken(text))
                case b.Formula(spoken=spoken):
                    parts.append(spoken)
                case b.Span(children=children):
                    parts.append(self._words(children))
                case b.Link(target=target, children=children):
                    parts.append(link_words(self._catalog, target, self._words(children)))
                case b.LineBreak():
                    parts.append(" ")
        return "".join(parts)


def sentences(text: str) -> list[str]:
    """A paragraph cut after each sentence."""
    out, start = [], 0
    for match in _SENTENCE_END.finditer(text):
        end = match.start() + len(match.group().rstrip())
        out.append(text[start:end].strip())
        start = end
    out.append(text[start:].strip())
    return [sentence for sentence in out if sentence]
