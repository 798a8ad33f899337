"""Lessons: Markdown in, typed blocks out.

The source is ordinary Markdown, so that it reads well in any viewer and lowers to a notebook almost
unchanged; ``docs/lesson-format.md`` describes it to authors. What is not in that description is refused with
file, line and fix, HTML above all: a terminal and a screen reader could not show it.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from course.catalog import blocks as b
from course.catalog.mathtext import MathError, math_spoken, math_text
from course.catalog.reading import read_text, split_front_matter
from course.errors import ContentError

if TYPE_CHECKING:
    from markdown_it import MarkdownIt
    from markdown_it.tree import SyntaxTreeNode

#: What dates a source.
YEAR = re.compile(r"\b(?:19|20)\d\d\b")
_ALTERNATIVE = re.compile(r"^\s*%\s*(text|spoken):\s*(.*?)\s*$")
_ACCESSIBLE = re.compile(r"^\s*accDescr:\s*(.+?)\s*$", re.MULTILINE)
_TARGET = re.compile(r"https://\S+|(?:lesson|exercise):[a-z][a-z0-9-]*(?:#[\w-]+)?|#[\w-]+")
_FORMAT_HELP = "docs/lesson-format.md lists what a lesson can hold."


def read_blocks(path: Path) -> tuple[b.Block, ...]:
    head = split_front_matter(read_text(path), path)
    return parse_lesson(head.body, path, first_line=head.body_line)


def read_task(path: Path) -> tuple[b.Block, ...]:
    """The blocks of a warm-up's README below its title; the caller has the title already."""
    title, _, body = read_text(path).partition("\n")
    if not title.startswith("# "):
        raise ContentError(path, 1, "the title is missing.", help="Start the file with: # Title")
    return parse_lesson(body, path, first_line=2)


def parse_lesson(body: str, file: Path, *, first_line: int = 1) -> tuple[b.Block, ...]:
    """Parse the Markdown of a lesson.

    Args:
        first_line: the line of the file that ``body`` starts on, counted from 1.
    """
    from markdown_it.tree import SyntaxTreeNode

    tree = SyntaxTreeNode(_parser().parse(body))
    return _Builder(file, first_line).blocks(tree.children)


def _parser() -> MarkdownIt:
    from markdown_it import MarkdownIt
    from mdit_py_plugins.dollarmath import dollarmath_plugin

    class Parser(MarkdownIt):
        """Leaves link targets as they are written: here they also hold Python expressions."""

        def validateLink(self, url: str) -> bool:  # noqa: ARG002, N802 - the library's name
            return True

        def normalizeLink(self, url: str) -> str:  # noqa: N802 - the library's name
            return url

    return Parser("commonmark").enable("table").use(dollarmath_plugin, allow_space=False, allow_digits=False)


class _Builder:
    """Turns the syntax tree of one file into blocks."""

    def __init__(self, file: Path, first_line: int) -> None:
        self._file = file
        self._first_line = first_line
        self._section = ""

    def _wrong(self, line: int, problem: str, help_: str = _FORMAT_HELP) -> ContentError:
        return ContentError(self._file, line, problem, help=help_)

    def _line(self, node: SyntaxTreeNode) -> int:
        return self._first_line + (node.map[0] if node.map else 0)

    # ------------------------------------------------------------ blocks

    def blocks(self, nodes: list[SyntaxTreeNode]) -> tuple[b.Block, ...]:
        out: list[b.Block] = []
        for node in nodes:
            out.append(self._block(node, out))
        for block in out:
            if isinstance(block, b.Diagram) and not block.drawing:
                problem = "the diagram has no drawing"
                raise self._wrong(block.line, problem, "Put a ```drawing fence right after it.")
        return tuple(out)

    def _block(self, node: SyntaxTreeNode, above: list[b.Block]) -> b.Block:  # noqa: PLR0911 - one return per kind
        """A block; one above that it completes is taken from there."""
        line = self._line(node)
        match node.type:
            case "heading":
                return self._heading(node, line)
            case "paragraph":
                return self._paragraph(node, line)
            case "bullet_list" | "ordered_list":
                return self._list(node, line)
            case "table":
                return self._table(node, line)
            case "fence":
                return self._fence(node, line, above)
            case "math_block":
                return self._math(node, line)
            case "blockquote":
                return self._quote(node, line)
            case "html_block":
                raise self._wrong(line, "HTML has no form in a terminal", "Say it in Markdown.")
            case other:
                raise self._wrong(line, f"a lesson has no {other.replace('_', ' ')}")

    def _heading(self, node: SyntaxTreeNode, line: int) -> b.Heading:
        level = int(node.tag[1:])
        if level not in (2, 3):
            raise self._wrong(line, f"a heading of level {level}", "Sections are ##, parts of a section ###.")
        if node.parent is None or node.parent.type != "root":
            raise self._wrong(line, "a heading inside a list or a quote", "Headings stand on their own.")
        heading = b.Heading(line, level, self._inlines_of(node))
        self._section = b.plain_text(heading.inlines)
        return heading

    def _paragraph(self, node: SyntaxTreeNode, line: int) -> b.Paragraph | b.Figure:
        pieces = node.children[0].children if node.children else []
        if pieces and pieces[0].type == "image":
            return self._figure(pieces, line)
        return b.Paragraph(line, self._inlines(pieces, line))

    def _figure(self, pieces: list[SyntaxTreeNode], line: int) -> b.Figure:
        target = str(pieces[0].attrs.get("src", ""))
        alt = pieces[0].content.strip()
        caption = self._inlines(pieces[1:], line)
        if not target.startswith("figure:"):
            problem = f"the picture {target} is not a figure"
            raise self._wrong(line, problem, "Name a figure: ![what is seen](figure:id).")
        if len(alt.split()) < 5:
            problem = "the figure has no alternative text of five words or more"
            raise self._wrong(line, problem, "Say in [ ] what the picture shows.")
        if not b.plain_text(caption).strip():
            problem = "the figure has no caption"
            raise self._wrong(line, problem, "State the finding on the line after the picture.")
        return b.Figure(line, target.removeprefix("figure:"), alt, _stripped(caption))

    def _list(self, node: SyntaxTreeNode, line: int) -> b.ListBlock | b.Sources:
        items = tuple(self.blocks(item.children) for item in node.children)
        if self._section == "Sources":
            return self._sources(items, line)
        start = int(node.attrs.get("start", 1)) if node.type == "ordered_list" else None
        return b.ListBlock(line, start, items)

    def _sources(self, items: tuple[tuple[b.Block, ...], ...], line: int) -> b.Sources:
        lines: list[b.Inlines] = []
        for item in items:
            if len(item) != 1 or not isinstance(item[0], b.Paragraph):
                raise self._wrong(line, "a source is one paragraph", "Keep each source in one list item.")
            if not YEAR.search(b.plain_text(item[0].inlines)):
                problem = "a source has no date"
                raise self._wrong(item[0].line, problem, "Give the year it was published or read.")
            lines.append(item[0].inlines)
        return b.Sources(line, tuple(lines))

    def _table(self, node: SyntaxTreeNode, line: int) -> b.Table:
        head = node.children[0].children[0].children
        body = node.children[1].children if len(node.children) > 1 else []
        align = tuple(str(cell.attrs.get("style", "")).removeprefix("text-align:") or "left" for cell in head)
        rows = tuple(tuple(self._inlines_of(cell) for cell in row.children) for row in body)
        return b.Table(line, tuple(self._inlines_of(cell) for cell in head), rows, align)

    def _fence(self, node: SyntaxTreeNode, line: int, above: list[b.Block]) -> b.Block:  # noqa: PLR0911 - one return per kind
        text = node.content.rstrip("\n")
        rows = node.content.removesuffix("\n").count("\n") + bool(node.content)
        if node.map and node.map[1] - node.map[0] < rows + 2:
            raise self._wrong(line, "a fence that is never closed", "End it with ``` on a line of its own.")
        before = above[-1] if above else None
        match node.info.split():
            case ["python"]:
                return b.CodeCell(line, text)
            case ["python", "hidden"]:
                return b.CodeCell(line, text, hidden=True)
            case ["output"] if isinstance(before, b.CodeCell) and before.output is None and not before.hidden:
                above.pop()
                return replace(before, output=text, output_line=line)
            case ["output"]:
                problem = "output that follows no shown code cell"
                raise self._wrong(line, problem, "Put it right after a ```python fence.")
            case ["text"]:
                return b.Listing(line, text)
            case ["console"]:
                return self._commands(text, line)
            case ["mermaid"]:
                return self._diagram(text, line)
            case ["drawing"] if isinstance(before, b.Diagram) and not before.drawing:
                above.pop()
                return replace(before, drawing=text)
            case ["drawing"]:
                problem = "a drawing that follows no diagram"
                raise self._wrong(line, problem, "Put it right after a ```mermaid fence.")
            case _:
                fix = "Mark it python, python hidden, output, text, console, mermaid or drawing."
                raise self._wrong(line, f"a fence marked {node.info.strip() or 'nothing'!r}", fix)

    def _commands(self, text: str, line: int) -> b.CommandList:
        commands = []
        for offset, row in enumerate(text.splitlines(), start=1):
            if not row.startswith("$ "):
                problem = "a line that is not a command"
                raise self._wrong(line + offset, problem, "Start each line with $ and a space.")
            command, _, note = row[2:].partition("  # ")
            commands.append(b.Command(command.strip(), note.strip()))
        return b.CommandList(line, tuple(commands))

    def _diagram(self, text: str, line: int) -> b.Diagram:
        described = _ACCESSIBLE.search(text)
        if not described:
            raise self._wrong(line, "the diagram has no description", "Add a line: accDescr: one sentence.")
        return b.Diagram(line, text, "", described[1])

    def _math(self, node: SyntaxTreeNode, line: int) -> b.MathBlock:
        given: dict[str, str] = {}
        tex: list[str] = []
        for row in node.content.splitlines():
            if found := _ALTERNATIVE.match(row):
                given[found[1]] = "\n".join(filter(None, [given.get(found[1]), found[2]]))
            else:
                tex.append(row)
        source = "\n".join(tex).strip()
        text = given.get("text") or self._formula(math_text, source, line, "text")
        spoken = given.get("spoken") or self._formula(math_spoken, source, line, "spoken")
        return b.MathBlock(line, source, text, spoken)

    def _quote(self, node: SyntaxTreeNode, line: int) -> b.Callout | b.Prediction:
        inner = self.blocks(node.children)
        kind, rest = _label(inner)
        if kind == "predict":
            return b.Prediction(line, rest)
        if kind not in b.CALLOUTS:
            labels = ", ".join(name.capitalize() for name in (*b.CALLOUTS, "predict"))
            problem = "a block quote without a known label"
            raise self._wrong(line, problem, f"Begin it with one in bold: {labels}.")
        return b.Callout(line, kind, rest)

    # ------------------------------------------------------------ inline

    def _inlines_of(self, node: SyntaxTreeNode) -> b.Inlines:
        pieces = node.children[0].children if node.children else []
        return self._inlines(pieces, self._line(node))

    def _inlines(self, pieces: list[SyntaxTreeNode], line: int) -> b.Inlines:
        out: list[b.Inline] = []
        for piece in pieces:
            inline = self._inline(piece, line)
            if isinstance(inline, b.Text) and out and isinstance(out[-1], b.Text):
                out[-1] = b.Text(out[-1].text + inline.text)
            elif inline != b.Text(""):
                out.append(inline)
        return tuple(out)

    def _inline(self, piece: SyntaxTreeNode, line: int) -> b.Inline:  # noqa: PLR0911 - one per kind
        match piece.type:
            case "text":
                return b.Text(piece.content)
            case "softbreak":
                return b.Text(" ")
            case "hardbreak":
                return b.LineBreak()
            case "em":
                return b.Span("emphasis", self._inlines(piece.children, line))
            case "strong":
                return b.Span("strong", self._inlines(piece.children, line))
            case "code_inline":
                return b.Span("code", (b.Text(piece.content),))
            case "math_inline":
                text = self._formula(math_text, piece.content, line, "text")
                return b.Formula(
                    piece.content, text, self._formula(math_spoken, piece.content, line, "spoken")
                )
            case "link":
                return self._link(piece, line)
            case "image":
                raise self._wrong(line, "a figure inside a paragraph", "Give it a paragraph of its own.")
            case "html_inline":
                problem = f"HTML has no form in a terminal: {piece.content}"
                raise self._wrong(line, problem, "Say it in Markdown.")
            case other:
                raise self._wrong(line, f"a line has no {other.replace('_', ' ')}")

    def _link(self, piece: SyntaxTreeNode, line: int) -> b.Link | b.Value:
        target = str(piece.attrs.get("href", ""))
        children = self._inlines(piece.children, line)
        if target.startswith("="):
            return b.Value(b.plain_text(children), target[1:].strip(), line)
        if not _TARGET.fullmatch(target):
            fix = "Link to https://…, lesson:ID, exercise:ID, #heading or =EXPRESSION."
            raise self._wrong(line, f"a link to {target!r}", fix)
        return b.Link(target, children, line)

    def _formula(self, convert: Callable[[str], str], tex: str, line: int, form: str) -> str:
        try:
            return convert(tex)
        except MathError as error:
            problem = f"the formula {tex.strip()!r} has no {form} form: {error}"
            fix = f"Write it with known commands, or give its own % {form}: line in $$."
            raise self._wrong(line, problem, fix) from error


def _stripped(line: b.Inlines) -> b.Inlines:
    """A line without the white space that its removed first piece left behind."""
    if line and isinstance(line[0], b.Text):
        rest = line[0].text.lstrip()
        return ((b.Text(rest),) if rest else ()) + line[1:]
    return line


def _label(inner: tuple[b.Block, ...]) -> tuple[str, tuple[b.Block, ...]]:
    """The bold word a block quote begins with, in lower case, and the quote without it."""
    match inner:
        case (b.Paragraph(line, (b.Span("strong", words), *more)), *others):
            label = b.plain_text(words).strip().rstrip(".:?").lower()
            rest = _stripped(tuple(more))
            return label, (*((b.Paragraph(line, rest),) if rest else ()), *others)
    return "", inner
