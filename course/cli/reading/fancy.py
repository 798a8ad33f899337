"""A lesson for sighted readers: wrapped prose, highlighted code, drawings, pictures where possible.

Colour and weight only repeat what a word or a mark already says. Prose is at most 78 columns wide; code,
output and drawings are not wrapped and, in lessons that pass the audit, fit in 60.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rich import box
from rich.console import Group
from rich.padding import Padding
from rich.segment import Segment
from rich.style import Style
from rich.table import Table
from rich.text import Text

from course.catalog import blocks as b
from course.cli.frame.terminal.code import Code
from course.cli.frame.terminal.pictures import picture, protocol_of
from course.cli.reading.words import LABELS, link_words, value_text

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping
    from pathlib import Path

    from rich.console import Console, ConsoleOptions, RenderableType

    from course.catalog.load import Catalog
    from course.catalog.models import Lesson

__all__ = ["KEEP", "FancyPrinter"]

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


class FancyPrinter:
    """Prints the parts of one lesson with Rich."""

    def __init__(
        self,
        catalog: Catalog,
        lesson: Lesson,
        console: Console,
        figure_ids: list[str],
        figures_dir: Path | None,
        width: int,
        environ: Mapping[str, str],
    ) -> None:
        self._catalog = catalog
        self._lesson = lesson
        self._console = console
        self._figure_ids = figure_ids
        self._figures_dir = figures_dir
        self._room = max(20, width - _MARGIN)
        self._prose = min(self._room, _PROSE)
        self._environ = environ
        self.pictures: list[Path] = []

    def head(self) -> None:
        """Title, summary, objectives."""
        lesson = self._lesson
        self._print(Text(lesson.title, style="bold"))
        self._print(Text(f"{lesson.id} · about {lesson.minutes} minutes", style="dim"))
        self._print(Text(lesson.summary), above=1)
        self._print(Text("After this lesson you can", style="bold"), above=1)
        self._print(self._bullets([Text(objective) for objective in lesson.objectives]))
        if lesson.exercises:
            commands = ", ".join(f"course start {name}" for name in lesson.exercises)
            self._print(Text.assemble(("Then practise: ", "bold"), (commands, _SPANS["code"])), above=1)

    def blocks(self, blocks: tuple[b.Block, ...]) -> None:
        """Print blocks in order, an empty line before each."""
        for block in blocks:
            shown = self._block(block)
            if shown is not None:
                self._print(shown, above=1)

    def _print(self, shown: RenderableType, *, above: int = 0) -> None:
        for _ in range(above):
            self._console.print()
        self._console.print(_Prefixed(shown, " " * _MARGIN), width=self._prose + _MARGIN)

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
            case b.Listing(text=text) | b.Diagram(drawing=text):
                return Text(text, no_wrap=True, overflow="fold")
            case b.MathBlock(text=text):
                widest = max(len(row) for row in text.splitlines())
                return Padding(Text(text), (0, 0, 0, min(4, max(0, self._prose - widest))))
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
            case _:
                return None

    def _heading(self, level: int, inlines: b.Inlines) -> RenderableType:
        text = self._text(inlines)
        text.stylize("bold")
        if level > 2:
            return text
        return Group(Text(""), text, Text("─" * min(self._prose, text.cell_len), style="dim"))

    def _passage(self, kind: str, inner: tuple[b.Block, ...]) -> RenderableType:
        label = Text(LABELS[kind], style=f"bold {_COLOURS[kind]}")
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
        widths = _column_widths(header, rows, self._prose)
        if widths is None:
            return _facts(header, rows)
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
        return Text(lead + "─" * (min(self._prose, 58) - len(lead)), style="dim")

    def _figure(self, figure: b.Figure) -> RenderableType:
        number = self._figure_ids.index(figure.id) + 1
        caption = Text.assemble((f"Figure {number}. ", "bold"), self._text(figure.caption))
        shown: list[RenderableType] = []
        from course.figures.registry import build

        drawn = picture(self._console, self._environ, lambda: build(figure.id), self._prose)
        if drawn is not None:
            shown.append(drawn)
        shown.append(caption)
        if not protocol_of(self._console, self._environ):  # half blocks are coarse: words go with them
            shown.append(Text.assemble(("To be seen: ", "bold"), figure.alt, style="dim"))
        shown.append(self._where(figure))
        return Group(*shown)

    def _where(self, figure: b.Figure) -> Text:
        """The picture's path, or the command that writes it."""
        if self._figures_dir is not None:
            from course.figures.registry import save

            path = save(figure.id, self._figures_dir)
            self.pictures.append(path)
            link = Style(link=path.absolute().as_uri())
            return Text.assemble(("Picture: ", "bold"), (str(path), link))
        if protocol_of(self._console, self._environ):
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


class _Prefixed:
    """Output with the same mark before each line, and without trailing blanks, so that none are copied."""

    def __init__(self, inner: RenderableType, mark: str, style: Style | None = None) -> None:
        self._inner = inner
        self._mark = mark
        self._style = style

    def __rich_console__(self, console: Console, options: ConsoleOptions) -> Iterator[Segment]:
        room = options.update_width(options.max_width - len(self._mark))
        for line in console.render_lines(self._inner, room, pad=False):
            kept = _stripped(line)
            if kept or self._style:
                yield Segment(self._mark, self._style)
            for text, style, control in kept:
                yield Segment(text.replace(KEEP, " "), style, control)
            yield Segment.line()


def _stripped(line: list[Segment]) -> list[Segment]:
    """A line without the blanks at its end; control codes stay."""
    kept = list(line)
    while kept and not kept[-1].control and not kept[-1].text.strip():
        kept.pop()
    if kept and not kept[-1].control:
        kept[-1] = Segment(kept[-1].text.rstrip(), kept[-1].style)
    return kept


def _commands(commands: tuple[b.Command, ...]) -> RenderableType:
    shown: list[RenderableType] = []
    for command in commands:
        shown.append(Text.assemble(("$ ", "dim"), (command.command, _SPANS["code"])))
        if command.note:
            shown.append(Padding(Text(command.note), (0, 0, 0, 4)))
    return Group(*shown)


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


def _facts(header: list[Text], rows: list[list[Text]]) -> RenderableType:
    """A table that is too wide, a row at a time."""
    shown: list[RenderableType] = []
    for row in rows:
        shown.append(Text.assemble(row[0], style="bold"))
        for name, cell in zip(header[1:], row[1:], strict=True):
            shown.append(Padding(Text.assemble(name, ": ", cell), (0, 0, 0, 2)))
    return Group(*shown)
