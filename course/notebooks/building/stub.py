"""A stub taken apart: the functions that a student writes, and the lines between them."""

from __future__ import annotations

import ast
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Collection

__all__ = ["Piece", "pieces"]


@dataclass(frozen=True)
class Piece:
    """Consecutive lines of a stub.

    Attributes:
        task: the function these lines define; "" for what is given.
        text: the lines, without empty ones at either end.
    """

    task: str
    text: str


def pieces(source: str, tasks: Collection[str]) -> tuple[str, list[Piece]]:
    """The module's docstring, and its lines in order: one piece for each task, the rest joined between them.

    Comments belong to the statement that follows them.
    """
    tree = ast.parse(source)
    lines = source.split("\n")
    about = ast.get_docstring(tree) or ""
    body = tree.body[1:] if about else tree.body
    found: list[Piece] = []
    start = (tree.body[0].end_lineno or 0) if about else 0
    for node in body:
        end = node.end_lineno or start
        text = "\n".join(lines[start:end]).strip("\n")
        start = end
        name = node.name if isinstance(node, ast.FunctionDef) and node.name in tasks else ""
        if not name and found and not found[-1].task:
            found[-1] = Piece("", f"{found[-1].text}\n{_gap(text, node)}{text}")
        else:
            found.append(Piece(name, text))
    return about, found


def _gap(text: str, node: ast.stmt) -> str:
    """The empty lines that a formatter would put before a statement."""
    if isinstance(node, ast.FunctionDef | ast.ClassDef):
        return "\n\n"
    return "" if text.startswith(("import ", "from ")) else "\n"
