"""The Python and the NumPy that a file was written with, and those that grade it.

A wheel notes those of whoever built it (``hatch_build.py``), and these grade. At home a file is compared with
them: what they cannot read, or have no name for, is worth a word before it costs anything.
"""

from __future__ import annotations

import ast
import functools
import importlib
import importlib.util
import io
import platform
import sys
import tokenize
from collections.abc import Iterator
from pathlib import Path

import msgspec
import numpy as np

from course.isolation.inside import statements
from course.scoring.elsewhere import instead
from course.scoring.verdict import Places

_NOTE = Path(__file__).parents[1] / "graded_with.json"
_MOST = 5


class Graders(msgspec.Struct, frozen=True):
    """What grades.

    Attributes:
        python, numpy: their versions; "" if unknown.
        names: what is in some of their modules.
        modules: of that Python's own.
    """

    python: str
    numpy: str = ""
    names: dict[str, frozenset[str]] = {}
    modules: frozenset[str] = frozenset()


def here() -> dict[str, str]:
    """The versions of this Python and its NumPy."""
    return {"python": platform.python_version(), "numpy": np.__version__}


@functools.cache
def _graders() -> Graders | None:
    """What grades; None in a checkout, which grades with itself."""
    try:
        return msgspec.json.decode(_NOTE.read_bytes(), type=Graders)
    except (OSError, msgspec.DecodeError):
        return None


def notes(source: bytes, places: Places, graders: Graders | None = None) -> list[str]:
    """What works here and not where it is graded, a sentence each; none if it is no Python here either."""
    graders = graders or _graders()
    if graders is None:
        return []
    try:
        text = importlib.util.decode_source(source)
    except (SyntaxError, ValueError):
        return []
    tree = statements.tree(text)
    if tree is None:
        return []
    told = []
    python = f"Python {graders.python}"
    if (line := _unreadable(text, tree, graders)) is not None:
        told.append(
            f"{places.heading(line)}: {python}, which grades, cannot read this; you have "
            f"{platform.python_version()}. Write it the older way."
        )
    for line, module, name in _missing(tree, graders):
        if not name:
            told.append(f"{places.heading(line)}: {python}, which grades, has no module `{module}`.")
            continue
        numpy = module.partition(".")[0] == "numpy"
        what, mine = (f"NumPy {graders.numpy}", np.__version__) if numpy else (python, here()["python"])
        shown = f"np{module[5:]}.{name}" if numpy else f"{module}.{name}"
        told.append(
            f"{places.heading(line)}: {what}, which grades, has no `{shown}`; you have {mine}."
            f"{instead(module, name)}"
        )
    return list(dict.fromkeys(told))[:_MOST]


# -- syntax -----------------------------------------------------------------------------------------------


def _unreadable(text: str, tree: ast.Module, graders: Graders) -> int | None:
    """The first line that an older Python cannot read; None if it reads all."""
    try:
        theirs = tuple(map(int, graders.python.split(".")[:2]))
    except ValueError:
        return None
    if len(theirs) != 2 or theirs >= sys.version_info[:2]:
        return None
    if not _reads(text, theirs):
        return _first_of(tree.body, text.split("\n"), theirs) or 1
    return _free_string(text) if theirs < (3, 12) else None


def _reads(text: str, version: tuple[int, ...]) -> bool:
    try:
        ast.parse(text, feature_version=(version[0], version[1]))
    except SyntaxError:
        return False
    return True


def _first_of(body: list[ast.stmt], lines: list[str], version: tuple[int, ...]) -> int | None:
    """The line of the innermost statement that a version cannot read; Python itself says where one ends."""
    for node in body:
        text = "if 1:\n" * (node.col_offset > 0) + "\n".join(lines[node.lineno - 1 : node.end_lineno])
        if not _reads(text, version):
            inner = [one for one in ast.iter_child_nodes(node) if isinstance(one, ast.stmt)]
            return _first_of(inner, lines, version) or node.lineno
    return None


def _free_string(text: str) -> int | None:
    """The line of an f-string that only Python 3.12 reads: quotes in its quotes, a backslash, a comment.

    ``feature_version`` lets these through.
    """
    quotes: list[str] = []  # of the f-strings that are open
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        kind = tokenize.tok_name[token.type]
        if kind == "FSTRING_END":
            quotes.pop()
            continue
        if quotes and kind != "FSTRING_MIDDLE":
            broken = kind in {"NL", "NEWLINE"} and len(quotes[-1]) == 1
            if broken or kind == "COMMENT" or "\\" in token.string or any(q in token.string for q in quotes):
                return token.start[0]
        if kind == "FSTRING_START":
            quotes.append(token.string.lstrip("fFrRbBuU"))
    return None


# -- names ------------------------------------------------------------------------------------------------


def _missing(tree: ast.Module, graders: Graders) -> Iterator[tuple[int, str, str]]:
    """(line, module, name) of what is here and not there; no name for a whole module."""
    called: dict[str, str] = {}
    for node in ast.walk(tree):
        match node:
            case ast.Import(names=names):
                for alias in names:
                    top = alias.name.partition(".")[0]
                    called[alias.asname or top] = alias.name if alias.asname else top
                    if _is_new(top, graders):
                        yield node.lineno, top, ""
            case ast.ImportFrom(module=str() as module, names=names, level=0):
                if _is_new(module.partition(".")[0], graders):
                    yield node.lineno, module, ""
                for alias in names:
                    called[alias.asname or alias.name] = f"{module}.{alias.name}"
                    if _is_here_alone(module, alias.name, graders):
                        yield node.lineno, module, alias.name
    for node in ast.walk(tree):
        if isinstance(node, ast.Attribute):
            module = _dotted(node.value, called)
            if _is_here_alone(module, node.attr, graders):
                yield node.lineno, module, node.attr


def _dotted(node: ast.expr, called: dict[str, str]) -> str:
    """The module that an expression such as ``np.linalg`` names; "" for any other."""
    if isinstance(node, ast.Name):
        return called.get(node.id, "")
    if isinstance(node, ast.Attribute) and (above := _dotted(node.value, called)):
        return f"{above}.{node.attr}"
    return ""


def _is_new(module: str, graders: Graders) -> bool:
    return bool(graders.modules) and module in sys.stdlib_module_names - graders.modules


def _is_here_alone(module: str, name: str, graders: Graders) -> bool:
    theirs = graders.names.get(module)
    return theirs is not None and name not in theirs and name in dir(importlib.import_module(module))
