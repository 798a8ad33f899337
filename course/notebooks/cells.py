"""Cells and whole notebooks, the same bytes every time they are generated.

A cell's id is a digest of its content, so a notebook generated again differs only where the content does. The
digest is also kept in the cell's metadata, which Jupyter leaves alone when it gives a copy another id; so
each cell shows by itself whether it was edited. nbformat's own constructors draw ids at random, and its
validation silently replaces duplicates; so ids are made here, and a cell that repeats another counts the
repetition into its id.
"""

import hashlib
import json
import re
from dataclasses import dataclass, field
from typing import Any

import msgspec

from course.catalog.blocks import anchor

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
        section = anchor(heading[1]) if heading else section
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
