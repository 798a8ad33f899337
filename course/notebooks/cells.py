"""Cells and whole notebooks, the same bytes every time they are generated.

A cell's id is a digest of its content, so a notebook generated again differs only where the content does. The
digest is also kept in the cell's metadata, which Jupyter leaves alone when it gives a copy another id; so
each cell shows by itself whether it was edited. nbformat's own constructors draw ids at random, and its
validation silently replaces duplicates; so ids are made here, and a cell that repeats another counts the
repetition into its id.
"""

import hashlib
import html
import json
import re
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, assert_never

import msgspec

from course.catalog import blocks as b

_KERNEL = {"display_name": "Python 3 (ipykernel)", "language": "python", "name": "python3"}
#: In the first cell of every notebook. The course is on no package index, so a file or folder is named.
_NEEDS = """\
<small>The code below needs the course itself. Where `import course` fails, install it from the wheel your
course hands out, `%pip install FILE.whl`, or from a checkout of it, `%pip install -e FOLDER`, and restart the
kernel.</small>"""
_SECTION = re.compile(r"#{2,3} (.+)")


@dataclass(frozen=True)
class Cell:
    """One cell before it has an id.

    Attributes:
        kind: "markdown" or "code".
        source: its text, without a final newline.
        metadata: kept with it; the course's own is under "course".
    """

    kind: str
    source: str
    metadata: dict[str, Any] = field(default_factory=dict)

    @property
    def tags(self) -> dict[str, Any]:
        """The course's own metadata."""
        tags: dict[str, Any] = self.metadata.get("course", {})
        return tags


def markdown(source: str, **tags: Any) -> Cell:
    """A text cell; ``tags`` is the course's own metadata."""
    return Cell("markdown", source.strip("\n"), {"course": {"role": "text", **tags}})


def opening(source: str) -> Cell:
    """The first cell of a notebook: its text, and how to install the course."""
    return markdown(f"{source}\n\n{_NEEDS}")


def code(source: str, **tags: Any) -> Cell:
    """A code cell; ``tags`` is the course's own metadata."""
    return Cell("code", source.strip("\n"), {"course": tags})


def digest(kind: str, source: str, tags: dict[str, Any]) -> str:
    """The digest of a cell's content; its ``slot``, and the digest itself, do not count."""
    held = [kind, source, {name: value for name, value in tags.items() if name not in ("slot", "made")}]
    return hashlib.sha256(msgspec.json.encode(held, order="sorted")).hexdigest()[:16]


def document(cells: list[Cell], **about: Any) -> bytes:
    """A notebook file of format 4.5, without outputs.

    Args:
        about: the course's own metadata of the whole notebook.
    """
    seen: dict[str, int] = {}
    slots: dict[str, int] = {}
    written = []
    section = "top"
    for cell in cells:
        heading = _SECTION.match(cell.source) if cell.kind == "markdown" else None
        section = b.anchor(heading[1]) if heading else section
        made = digest(cell.kind, cell.source, cell.tags)
        tags = {**cell.tags, "made": made, "slot": _counted(slots, _slot(cell, section))}
        entry: dict[str, Any] = {
            "cell_type": cell.kind,
            "id": _counted(seen, made),
            "metadata": {**cell.metadata, "course": tags},
            "source": cell.source.splitlines(keepends=True),
        }
        if cell.kind == "code":
            entry |= {"execution_count": None, "outputs": []}
        written.append(entry)
    notebook = {
        "cells": written,
        "metadata": {"course": about, "kernelspec": _KERNEL, "language_info": {"name": "python"}},
        "nbformat": 4,
        "nbformat_minor": 5,
    }
    return dumped(notebook)


def dumped(notebook: dict[str, Any]) -> bytes:
    """A notebook as the bytes of its file."""
    return (json.dumps(notebook, ensure_ascii=False, indent=1, sort_keys=True) + "\n").encode()


def _slot(cell: Cell, section: str) -> str:
    """A cell's place, the same in every version of its notebook: it matches the cells of two versions."""
    role = cell.tags.get("role", cell.kind)
    if "task" in cell.tags or "exercise" in cell.tags:
        return f"{role}:{cell.tags.get('task', '')}"  # whatever the section around it is called
    return f"{section}:{role}"


def _counted(seen: dict[str, int], name: str) -> str:
    seen[name] = seen.get(name, 0) + 1
    return name if seen[name] == 1 else f"{name}-{seen[name]}"


# ---
# A lesson's blocks as Markdown that Jupyter shows without any extension.
#
# JupyterLab itself draws mermaid, mathematics, tables and quotes, offline. Everything else in a lesson is
# turned into one of these.


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
