"""A lesson on a terminal: laid out for the screen, or line by line for a screen reader.

A page ends where a section ends, and after each prediction, since the figure that answers it must not be in
sight; and after each answer, which is compared with what was predicted.
"""

import os
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import assert_never

from rich import box
from rich.cells import cell_len
from rich.console import Console, ConsoleOptions, Group, RenderableType
from rich.padding import Padding
from rich.segment import Segment
from rich.style import Style
from rich.table import Table
from rich.text import Text

from course.catalog import blocks as b
from course.catalog.load import Catalog
from course.cli.frame.pictures import Code, picture, protocol_of
from course.errors import NotFoundError
from course.figures.registry import build, save
from course.printable import counted
from course.reading.parts import Script, is_unseen

# ---
# Words shared by all ways of printing a lesson.


#: The heading of a prediction; that of another passage is its kind.
_PREDICT = "Predict first"

_SCIENTIFIC = re.compile(r"^([-+−]?[\d.]+)e([-+]?\d+)")
_RAISED = str.maketrans("0123456789-", "⁰¹²³⁴⁵⁶⁷⁸⁹⁻")


def value_text(text: str) -> str:
    """A quoted number as people write it: 4.4e8 is 4.4 × 10⁸, a hyphen is a minus sign."""
    if found := _SCIENTIFIC.match(text):
        power = "10" + str(int(found[2])).translate(_RAISED)
        text = (power if found[1] == "1" else f"{found[1]} × {power}") + text[found.end() :]
    return re.sub(r"^-", "−", text)


def value_spoken(text: str) -> str:
    """A quoted number as people say it."""
    spoken = _SCIENTIFIC.sub(lambda m: f"{m[1]} times 10 to the power {int(m[2])}", text)
    return re.sub(r"(^|(?<=power ))[-−]", "minus ", spoken)


def link_words(catalog: Catalog, target: str, words: str) -> str:
    """The words of a link and, unless they say it already, where it leads."""
    kind, _, rest = target.partition(":")
    name = rest.partition("#")[0]
    if kind == "https":
        return words if target.removeprefix("https://") == words else f"{words} ({target})"
    if target.startswith("#"):
        return words
    command = f"course lesson {name}" if kind == "lesson" else f"course start {name}"
    try:
        (catalog.lesson if kind == "lesson" else catalog.exercise)(name)
    except NotFoundError:
        return words
    return f"{words} ({command})"


class _Printer:
    """Prints the parts of one lesson on one console.

    Args:
        catalog: names what the lesson links to.
        figures_dir: folder to write the figures to as PNG; None writes none. A UsageError is raised where it
            cannot be written to.
        wraps: plain lines wrap between words.

    Attributes:
        pictures: those written so far.
    """

    def __init__(
        self,
        catalog: Catalog,
        script: Script,
        console: Console,
        figures_dir: Path | None = None,
        wraps: bool = False,
    ) -> None:
        self._catalog = catalog
        self._lesson = script.lesson
        self._console = console
        self._figure_ids = [one.id for one in b.walk_blocks(script.blocks) if isinstance(one, b.Figure)]
        self._figures_dir, self._wraps = figures_dir, wraps
        self._room = min(max(20, console.width - _MARGIN), _PROSE)  # columns of prose that is laid out
        self._told_how = False  # to save figures: said once
        self.pictures: list[Path] = []

    def _number_of(self, figure: b.Figure) -> int:
        return self._figure_ids.index(figure.id) + 1

    def _saved(self, figure: b.Figure) -> Path:
        assert self._figures_dir is not None
        self.pictures.append(save(figure.id, self._figures_dir))
        return self.pictures[-1]


# ---
# A lesson for a screen reader or a log: one fact per line, no boxes, no meaning in position or colour.
#
# Formulae are words, a diagram is its description, a table row is one "column: value" line per cell, and a
# paragraph has one sentence a line. Lines are never wrapped, because a screen reader does that better; only
# on a terminal without layout (TERM=dumb) do words wrap.


# A full stop after a single capital is an initial (E. Hairer), not an end.
_SENTENCE_END = re.compile(r"(?<=[.!?])(?<!\b[A-Z]\.)[\"”)]?\s+(?=[A-Z\"“(\d])")


class PlainPrinter(_Printer):
    """Prints the parts of one lesson as plain lines."""

    def head(self) -> None:
        lesson = self._lesson
        self._say(f"Lesson: {lesson.title}")
        self._say(f"Reading time: about {counted(lesson.minutes, 'minute')}")
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
                    self._say(f"Formula: {row}")
            case b.Diagram(description=description):
                self._say(f"Diagram: {description}")
            case b.Figure():
                self._figure(block)
            case b.Prediction(blocks=inner):
                self._labelled(_PREDICT, inner)
            case b.Callout(kind=kind, blocks=inner):
                self._labelled(kind.capitalize(), inner)
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
            case b.CodeCell():
                pass  # a hidden one
            case _:
                assert_never(block)

    def _prose(self, text: str) -> None:
        for line in sentences(text):
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
        self._say(f"Table, {counted(len(table.rows), 'row')} of {', '.join(names)}")
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
        self._say(f"{label}, {counted(len(rows), 'line')}:")
        for row in rows:
            self._say(row, whole=True)
        self._say(f"End of {'output' if label == 'It prints' else label.lower()}")

    def _figure(self, figure: b.Figure) -> None:
        self._prose(f"Figure {self._number_of(figure)}: {self._words(figure.caption)}")
        self._prose(f"The figure shows: {figure.alt}")
        if self._figures_dir is None:
            if not self._told_how:
                self._say(f"To save the pictures: course lesson {self._lesson.id} --figures DIR")
            self._told_how = True
            return
        self._say(f"Picture: {self._saved(figure)}")

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
    cut = _SENTENCE_END.sub(lambda end: f"{end[0].rstrip()}\0", text)
    return [sentence.strip() for sentence in cut.split("\0") if sentence.strip()]


# ---
# A lesson for sighted readers: wrapped prose, highlighted code, drawings, pictures where possible.
#
# Colour and weight only repeat what a word or a mark already says. Prose is at most 78 columns wide; code,
# output and drawings are not wrapped and, in lessons that pass the audit, fit in 60.


_MARGIN = 2
_PROSE = 78
_GAP = 3  # between the columns of a table
#: A character of Unicode's private use, at which Rich does not break a line; the last step makes it a space.
KEEP = "\ue000"
#: A formula up to this length stays on one line.
_SHORT = 16
_COLOURS = {
    "predict": "yellow",
    "answer": "green",
    "myth": "red",
    "fact": "green",
    "analogy": "blue",
    "remember": "magenta",
    "note": "cyan",
}
_SPANS = {"emphasis": "italic", "strong": "bold", "code": "bold cyan"}


class FancyPrinter(_Printer):
    """Prints the parts of one lesson with Rich."""

    def head(self) -> None:
        for shown, above in self._head(f"{self._lesson.id} · "):
            self._print(shown, above=above)

    def _head(self, before_minutes: str = "") -> Iterator[tuple[RenderableType, int]]:
        """Each with the empty lines above it."""
        lesson = self._lesson
        yield Text(lesson.title, style="bold"), 0
        yield Text(f"{before_minutes}about {counted(lesson.minutes, 'minute')}", style="dim"), 0
        yield Text(lesson.summary), 1
        yield Text("After this lesson you can", style="bold"), 1
        yield self._bullets([Text(objective) for objective in lesson.objectives]), 0
        if lesson.exercises:
            commands = ", ".join(f"course start {name}" for name in lesson.exercises)
            yield Text.assemble(("Then practise: ", "bold"), (commands, _SPANS["code"])), 1

    def blocks(self, blocks: tuple[b.Block, ...]) -> None:
        """Print blocks in order, an empty line before each."""
        for block in blocks:
            shown = self._block(block)
            if shown is not None:
                self._print(shown, above=1)

    def _print(self, shown: RenderableType, *, above: int = 0) -> None:
        for _ in range(above):
            self._console.print()
        self._console.print(_Prefixed(shown, " " * _MARGIN), width=self._room + _MARGIN)

    def _block(self, block: b.Block) -> RenderableType | None:  # noqa: C901, PLR0911, PLR0912 - one per kind
        match block:
            case b.Heading(level=level, inlines=inlines):
                return self._heading(level, inlines)
            case b.Paragraph(inlines=inlines):
                return self._text(inlines)
            case b.ListBlock():
                return self._list(block)
            case b.Table():
                return self._table(block)
            case b.CodeCell(hidden=False):
                return self._code(block)
            # What does not fit into the screen is said in words, as on paper.
            case b.Diagram(drawing=text, description=description) if _widest(text) > self._room:
                return Text(f"Diagram: {description}")
            case b.Listing(text=text) | b.Diagram(drawing=text):
                return Text(text, no_wrap=True, overflow="fold")
            case b.MathBlock(text=text, spoken=spoken):
                widest = _widest(text)
                if widest > self._room:
                    return Text(spoken)
                return Padding(Text(text), (0, 0, 0, min(4, max(0, self._room - widest))))
            case b.Figure():
                return self._figure(block)
            case b.Prediction(blocks=inner):
                return self._passage("predict", inner)
            case b.Callout(kind=kind, blocks=inner):
                return self._passage(kind, inner)
            case b.CommandList(commands=commands):
                return _commands(commands)
            case b.Task(id=name, what=what, title=title):
                return _commands((b.Command(f"course warmup {name}", f"{what.capitalize()}: {title}"),))
            case b.Sources(items=items):
                return self._bullets([self._text(item) for item in items])
            case b.CodeCell():
                return None  # a hidden one
            case _:
                assert_never(block)

    def _heading(self, level: int, inlines: b.Inlines) -> RenderableType:
        text = self._text(inlines)
        text.stylize("bold")
        if level > 2:
            return text
        return Group(Text(""), text, Text("─" * min(self._room, text.cell_len), style="dim"))

    def _passage(self, kind: str, inner: tuple[b.Block, ...]) -> RenderableType:
        heading = _PREDICT if kind == "predict" else kind.capitalize()
        label = Text(heading, style=f"bold {_COLOURS[kind]}")
        shown: list[RenderableType] = [label]
        for index, block in enumerate(inner):
            piece = self._block(block)
            if piece is not None:
                shown.append(Padding(piece, (1 if index else 0, 0, 0, 0)))
        return _Prefixed(Group(*shown), "┃ ", Style.parse(_COLOURS[kind]))

    def _list(self, block: b.ListBlock) -> RenderableType:
        items: list[RenderableType] = []
        for item in block.items:
            pieces = [piece for piece in map(self._block, item) if piece is not None]
            items.append(pieces[0] if len(pieces) == 1 else Group(*pieces))
        return self._bullets(items, block.start)

    @staticmethod
    def _bullets(items: list[RenderableType] | list[Text], start: int | None = None) -> RenderableType:
        grid = Table.grid(padding=(0, 1, 0, 0))
        grid.add_column(no_wrap=True, justify="right" if start is not None else "left")
        grid.add_column(overflow="fold", ratio=1)
        for number, item in enumerate(items, start=start or 1):
            grid.add_row(Text("•" if start is None else f"{number}."), item)
        return grid

    def _table(self, table: b.Table) -> RenderableType:
        header = [self._text(cell) for cell in table.header]
        rows = [[self._text(cell) for cell in row] for row in table.rows]
        widths = _column_widths(header, rows, self._room)
        if widths is None:  # too wide: a row at a time
            facts: list[RenderableType] = []
            for row in rows:
                facts.append(Text.assemble(row[0], style="bold"))
                for name, cell in zip(header[1:], row[1:], strict=True):
                    facts.append(Padding(Text.assemble(name, ": ", cell), (0, 0, 0, 2)))
            return Group(*facts)
        shown = Table(box=box.SIMPLE_HEAD, show_edge=False, pad_edge=False, header_style="bold")
        for cell, align, width in zip(header, table.align, widths, strict=True):
            shown.add_column(cell, justify="right" if align == "right" else "left", width=width)
        for row in rows:
            shown.add_row(*row)
        return shown

    def _code(self, cell: b.CodeCell) -> RenderableType:
        shown: list[RenderableType] = [self._rule("Python"), Code(cell.source)]
        if cell.output is not None:
            shown += [self._rule("prints"), Text(cell.output)]
        return Group(*shown, self._rule(""))

    def _rule(self, label: str) -> Text:
        lead = f"── {label} " if label else ""
        return Text(lead + "─" * (min(self._room, 58) - len(lead)), style="dim")

    def _figure(self, figure: b.Figure) -> RenderableType:
        shown: list[RenderableType] = []
        drawn = picture(self._console, os.environ, lambda: build(figure.id), self._room)
        if drawn is not None:
            shown.append(drawn)
        shown.append(self._caption(figure))
        if not protocol_of(self._console, os.environ):  # half blocks are coarse: words go with them
            shown.append(Text.assemble(("To be seen: ", "bold"), figure.alt, style="dim"))
        shown.append(self._where(figure))
        return Group(*shown)

    def _caption(self, figure: b.Figure) -> Text:
        return Text.assemble((f"Figure {self._number_of(figure)}. ", "bold"), self._text(figure.caption))

    def _where(self, figure: b.Figure) -> Text:
        """The picture's path, or the command that writes it."""
        if self._figures_dir is not None:
            path = self._saved(figure)
            link = Style(link=path.absolute().as_uri())
            return Text.assemble(("Picture: ", "bold"), (str(path), link))
        if protocol_of(self._console, os.environ):
            return Text("")
        command = f"course lesson {self._lesson.id} --figures DIR"
        return Text.assemble(("Picture: ", "bold"), (command, _SPANS["code"]))

    def _text(self, inlines: b.Inlines) -> Text:
        text = Text()
        for inline in inlines:
            match inline:
                case b.Text(words):
                    text.append(words)
                case b.Value(text=words):
                    text.append(value_text(words))
                case b.Formula(text=words):
                    text.append(words.replace(" ", KEEP) if len(words) <= _SHORT else words)
                case b.Span(style, children):
                    inner = self._text(children)
                    if style == "code" and self._console.no_color:  # a name that is an English word, too
                        inner = Text.assemble("`", inner, "`")
                    inner.stylize(_SPANS[style])
                    text.append_text(inner)
                case b.Link(target=target, children=children):
                    text.append_text(self._link(target, children))
                case b.LineBreak():
                    text.append("\n")
        return text

    def _link(self, target: str, children: b.Inlines) -> Text:
        words = self._text(children).plain
        style = Style(link=target) if target.startswith("https:") else Style()
        return Text(link_words(self._catalog, target, words), style=style + Style(underline=False))


@dataclass(frozen=True)
class _Prefixed:
    """Output with the same mark before each line, and without trailing blanks, so that none are copied."""

    inner: RenderableType
    mark: str
    style: Style | None = None

    def __rich_console__(self, console: Console, options: ConsoleOptions) -> Iterator[Segment]:
        room = options.update_width(options.max_width - len(self.mark))
        for line in console.render_lines(self.inner, room, pad=False):
            kept = list(line)  # without the blanks at its end; control codes stay
            while kept and not kept[-1].control and not kept[-1].text.strip():
                kept.pop()
            if kept and not kept[-1].control:
                kept[-1] = Segment(kept[-1].text.rstrip(), kept[-1].style)
            if kept or self.style:
                yield Segment(self.mark, self.style)
            for text, style, control in kept:
                yield Segment(text.replace(KEEP, " "), style, control)
            yield Segment.line()


def _commands(commands: tuple[b.Command, ...]) -> RenderableType:
    shown: list[RenderableType] = []
    for command in commands:
        shown.append(Text.assemble(("$ ", "dim"), (command.command, _SPANS["code"])))
        if command.note:
            shown.append(Padding(Text(command.note), (0, 0, 0, 4)))
    return Group(*shown)


def _widest(text: str) -> int:
    """Columns of the longest row."""
    return max(map(cell_len, text.splitlines()), default=0)


def _column_widths(header: list[Text], rows: list[list[Text]], room: int) -> list[int] | None:
    """Widths that fit: no column is narrower than its longest word, and the rest is shared out by need.

    None if the longest words alone do not fit.
    """
    columns = list(zip(header, *rows, strict=True))
    least = [max(len(word) for cell in cells for word in (cell.plain.split() or [""])) for cells in columns]
    most = [max(cell.cell_len for cell in cells) for cells in columns]
    spare = room - sum(least) - _GAP * (len(columns) - 1)
    wanted = [high - low for low, high in zip(least, most, strict=True)]
    if spare < 0:
        return None
    if sum(wanted) <= spare:
        return most
    return [low + spare * want // sum(wanted) for low, want in zip(least, wanted, strict=True)]


Printer = PlainPrinter | FancyPrinter


def printer(
    catalog: Catalog,
    script: Script,
    console: Console,
    *,
    plain: bool = False,
    figures_dir: Path | None = None,
    wraps: bool = False,
) -> Printer:
    """What prints a lesson on one console.

    Args:
        plain: one fact a line, no boxes, formulae in words, figures and diagrams as their descriptions.
        wraps: plain lines wrap between words.
    """
    # A terminal that cannot show the drawings and formulae gets what a screen reader gets.
    is_plain = plain or not console.encoding.lower().startswith("utf")
    return (PlainPrinter if is_plain else FancyPrinter)(catalog, script, console, figures_dir, wraps)


def paginate(blocks: tuple[b.Block, ...]) -> tuple[tuple[b.Block, ...], ...]:
    """Blocks as pages, each a screenful of reading: a section, or a section up to a prediction.

    A task has a page of its own, and none shows nothing.
    """
    pages: list[tuple[b.Block, ...]] = []
    current: list[b.Block] = []
    ended = False
    for block in blocks:
        begins = isinstance(block, b.Task) or (isinstance(block, b.Heading) and block.level == 2)
        if (begins or ended) and not all(map(is_unseen, current)):
            pages.append(tuple(current))
            current = []
        current.append(block)
        answers = isinstance(block, b.Callout) and block.kind == "answer"
        ended = answers or isinstance(block, b.Prediction | b.Task)
    if pages and all(map(is_unseen, current)):
        pages[-1] += tuple(current)
    elif current:
        pages.append(tuple(current))
    return tuple(pages)
