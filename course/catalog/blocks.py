"""The parts of a lesson as frozen types: inline pieces inside blocks.

Every reader of a lesson (terminal, notebook, audit) works from these and never from Markdown. A block knows
the line it starts on, so that a fault in it can be reported with its line.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import assert_never


@dataclass(frozen=True, slots=True)
class Text:
    """Words."""

    text: str


@dataclass(frozen=True, slots=True)
class Span:
    """Words set apart.

    Attributes:
        style: "emphasis", "strong" or "code"; code holds exactly one Text.
    """

    style: str
    children: Inlines


@dataclass(frozen=True, slots=True)
class Formula:
    """Mathematics in a line of prose.

    Attributes:
        tex: the LaTeX source, without dollars.
        text: what a terminal shows.
        spoken: what a screen reader says.
    """

    tex: str
    text: str
    spoken: str


@dataclass(frozen=True, slots=True)
class Link:
    """A link.

    Attributes:
        target: ``https://…``, ``lesson:ID`` or ``exercise:ID`` with or without ``#heading``, or ``#heading``.
    """

    target: str
    children: Inlines
    line: int


@dataclass(frozen=True, slots=True)
class Value:
    """A number (or word) that code produces.

    Attributes:
        text: as the reader sees it, "0.0890".
        expression: Python that gives it, evaluated where the lesson's code cells ran.
    """

    text: str
    expression: str
    line: int


@dataclass(frozen=True, slots=True)
class LineBreak:
    """A line break set by the author."""


Inline = Text | Span | Formula | Link | Value | LineBreak
Inlines = tuple[Inline, ...]


@dataclass(frozen=True, slots=True)
class Heading:
    """A section (level 2) or subsection (level 3); level 1 is the lesson's title, from the front matter."""

    line: int
    level: int
    inlines: Inlines


@dataclass(frozen=True, slots=True)
class Paragraph:
    line: int
    inlines: Inlines


@dataclass(frozen=True, slots=True)
class ListBlock:
    """A list; ``start`` is None for bullets and the first number otherwise."""

    line: int
    start: int | None
    items: tuple[tuple[Block, ...], ...]


@dataclass(frozen=True, slots=True)
class Table:
    """A table; ``align`` holds "left", "right" or "center" for each column."""

    line: int
    header: tuple[Inlines, ...]
    rows: tuple[tuple[Inlines, ...], ...]
    align: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class CodeCell:
    """Python that runs, in order, in one namespace for the whole lesson.

    Attributes:
        source: the code, without a final newline.
        output: its recorded output; None if there is none.
        hidden: run for the numbers it makes and not shown.
        output_line: line of the recorded output's fence; None when nothing is recorded.
    """

    line: int
    source: str
    output: str | None = None
    hidden: bool = False
    output_line: int | None = None


@dataclass(frozen=True, slots=True)
class Listing:
    """Text shown as it is and never run."""

    line: int
    text: str


@dataclass(frozen=True, slots=True)
class MathBlock:
    """Mathematics on lines of its own; the attributes are those of Formula."""

    line: int
    tex: str
    text: str
    spoken: str


@dataclass(frozen=True, slots=True)
class Diagram:
    """A diagram, three times over.

    Attributes:
        mermaid: for readers that draw it.
        drawing: for terminals.
        description: one sentence, for screen readers.
    """

    line: int
    mermaid: str
    drawing: str
    description: str


@dataclass(frozen=True, slots=True)
class Figure:
    """A figure that ``course.figures`` draws.

    Attributes:
        alt: what the figure shows, for a reader who cannot see it.
        caption: what it shows, the finding first.
    """

    line: int
    id: str
    alt: str
    caption: Inlines


@dataclass(frozen=True, slots=True)
class Prediction:
    """A question the reader answers before reading on."""

    line: int
    blocks: tuple[Block, ...]


#: Closed on purpose: an unknown label is a typing error, not a new kind.
CALLOUTS = ("myth", "fact", "analogy", "answer", "remember", "note")


@dataclass(frozen=True, slots=True)
class Callout:
    """A passage with a role of its own: one of CALLOUTS."""

    line: int
    kind: str
    blocks: tuple[Block, ...]


@dataclass(frozen=True, slots=True)
class Command:
    """One command to try, and what it is for (may be empty)."""

    command: str
    note: str


@dataclass(frozen=True, slots=True)
class CommandList:
    """Commands to type, in order."""

    line: int
    commands: tuple[Command, ...]


@dataclass(frozen=True, slots=True)
class Sources:
    """Where the outside facts come from; every item carries a year."""

    line: int
    items: tuple[Inlines, ...]


@dataclass(frozen=True, slots=True)
class Task:
    """A warm-up or an exercise that stands in a lesson while it is read.

    Attributes:
        what: its kind in words, such as "exercise".
        blocks: its own text, which is not part of the lesson.
    """

    line: int
    id: str
    what: str
    title: str
    blocks: tuple[Block, ...]


Block = (
    Heading
    | Paragraph
    | ListBlock
    | Table
    | CodeCell
    | Listing
    | MathBlock
    | Diagram
    | Figure
    | Prediction
    | Callout
    | CommandList
    | Sources
    | Task
)


def plain_text(inlines: Inlines) -> str:
    """The words of a line, marks and links left out."""
    pieces = (one for one in flattened(inlines) if not isinstance(one, Span | Link))
    return "".join(" " if isinstance(one, LineBreak) else one.text for one in pieces)


def slug(heading: Heading) -> str:
    """The heading as an anchor."""
    return anchor(plain_text(heading.inlines))


def anchor(heading: str) -> str:
    """A heading's words in lower case, joined by hyphens."""
    return "-".join("".join(char if char.isalnum() else " " for char in heading.lower()).split())


def walk_blocks(blocks: tuple[Block, ...]) -> Iterator[Block]:
    """Every block, outer ones before what they hold, in reading order."""
    for block in blocks:
        yield block
        match block:
            case Prediction(blocks=inner) | Callout(blocks=inner):
                yield from walk_blocks(inner)
            case ListBlock(items=items):
                for item in items:
                    yield from walk_blocks(item)
            case Heading() | Paragraph() | Table() | CodeCell() | Listing() | MathBlock() | Diagram():
                pass
            case Figure() | CommandList() | Task() | Sources():
                pass
            case _:
                assert_never(block)


def walk_inlines(blocks: tuple[Block, ...]) -> Iterator[tuple[Block, Inline]]:
    """Every inline piece with the innermost block it stands in, in reading order."""
    for block in walk_blocks(blocks):
        for line in lines_of(block):
            for inline in flattened(line):
                yield block, inline


def lines_of(block: Block) -> tuple[Inlines, ...]:
    """The lines of prose in a block itself, not in blocks that it holds."""
    match block:
        case Heading(inlines=line) | Paragraph(inlines=line) | Figure(caption=line):
            return (line,)
        case Table(header=header, rows=rows):
            return (*header, *(cell for row in rows for cell in row))
        case Sources(items=items):
            return items
        case ListBlock() | CodeCell() | Listing() | MathBlock() | Diagram():
            return ()
        case Prediction() | Callout() | CommandList() | Task():
            return ()
        case _:
            assert_never(block)


def flattened(inlines: Inlines) -> Iterator[Inline]:
    """Every piece of a line, outer ones before what they hold."""
    for inline in inlines:
        yield inline
        if isinstance(inline, Span | Link):
            yield from flattened(inline.children)
