"""A lesson's blocks as Markdown that Jupyter shows without any extension.

JupyterLab itself draws mermaid, mathematics, tables and quotes, offline. Everything else in a lesson is
turned into one of these.
"""

import html
import re
from collections.abc import Callable
from typing import assert_never

from course.catalog import blocks as b

_SPECIAL = re.compile(r"([\\`*_\[\]<>$|])")


class Lowering:
    """Turns blocks into Markdown.

    Args:
        link: gives the address for a target like ``lesson:accuracy#drift`` or ``exercise:integrators``.
    """

    def __init__(self, link: Callable[[str], str]) -> None:
        self._link = link

    def block(self, block: b.Block) -> str:
        """One block; code cells, figures and predictions are cells of their own and not lowered here."""
        match block:
            case b.Heading(level=level, inlines=inlines):
                text = f"{'#' * level} {self.inlines(inlines)}"
            case b.Paragraph(inlines=inlines):
                text = self.inlines(inlines)
            case b.ListBlock(start=start, items=items):
                text = self._list(start, items)
            case b.Table():
                text = self._table(block)
            case b.Listing(text=shown):
                text = f"```text\n{shown}\n```"
            case b.MathBlock(tex=tex):
                text = f"$$\n{_without_comments(tex)}\n$$"
            case b.Diagram(mermaid=mermaid, description=description):
                text = f"```mermaid\n{mermaid}\n```\n\n*{escaped(description)}*"
            case b.Callout(kind=kind, blocks=blocks):
                text = self.boxed(kind, blocks)
            case b.CommandList(commands=commands):
                text = self._commands(commands)
            case b.Sources(items=items):
                text = "\n".join(f"- {self.inlines(item)}" for item in items)
            case b.CodeCell() | b.Figure() | b.Prediction() | b.Task():
                raise TypeError(f"{type(block).__name__} is a cell of its own")
            case _:
                assert_never(block)
        return text

    def blocks(self, blocks: tuple[b.Block, ...]) -> str:
        return "\n\n".join(self.block(block) for block in blocks)

    def boxed(self, kind: str, blocks: tuple[b.Block, ...]) -> str:
        """A passage with a heading, set off as a quote: that can be read on the ground of every theme."""
        text = f"**{kind.capitalize()}.**\n\n{self.blocks(blocks)}"
        return "\n".join(f"> {line}".rstrip() for line in text.split("\n"))

    def inlines(self, inlines: b.Inlines) -> str:
        return "".join(map(self._inline, inlines))

    def _inline(self, inline: b.Inline) -> str:
        match inline:
            case b.Text(words):
                shown = escaped(words)
            case b.Span("code", (b.Text(text),)):
                fence = "``" if "`" in text else "`"
                shown = f"{fence}{text}{fence}"
            case b.Span(style, children):
                mark = "**" if style == "strong" else "*"
                shown = f"{mark}{self.inlines(children)}{mark}"
            case b.Formula(tex=tex):
                shown = f"${tex}$"
            case b.Link(target=target, children=children):
                shown = f"[{self.inlines(children)}]({self._link(target)})"
            case b.Value(text=words):
                shown = escaped(words)
            case b.LineBreak():
                shown = "  \n"
            case _:
                assert_never(inline)
        return shown

    def _list(self, start: int | None, items: tuple[tuple[b.Block, ...], ...]) -> str:
        lines = []
        for number, item in enumerate(items, start or 1):
            mark = "- " if start is None else f"{number}. "
            body = self.blocks(item).replace("\n", "\n" + " " * len(mark))
            lines.append(mark + body)
        return "\n".join(re.sub(r"[ \t]+$", "", line, flags=re.MULTILINE) for line in lines)

    def _table(self, table: b.Table) -> str:
        rules = {"left": ":--", "right": "--:", "center": ":-:"}
        rows = [
            [self.inlines(cell) for cell in table.header],
            [rules[align] for align in table.align],
            *([self.inlines(cell) for cell in row] for row in table.rows),
        ]
        return "\n".join(f"| {' | '.join(row)} |" for row in rows)

    def _commands(self, commands: tuple[b.Command, ...]) -> str:
        lines = [f"{one.command}  # {one.note}" if one.note else one.command for one in commands]
        return "In a terminal:\n\n```bash\n" + "\n".join(lines) + "\n```"


def escaped(text: str) -> str:
    """Text with Markdown's special characters escaped."""
    return _SPECIAL.sub(r"\\\1", html.unescape(text)) if _SPECIAL.search(text) else text


def _without_comments(tex: str) -> str:
    """The formula without the comments that hold its text and spoken forms."""
    return "\n".join(line for line in tex.split("\n") if not line.lstrip().startswith("%")).strip("\n")
