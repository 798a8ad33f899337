"""The code cells of a notebook that was handed in, as plain Python.

A notebook is read as data: nothing of it runs, and its outputs are skipped. What IPython adds to Python is
taken out line by line, so that every other line keeps its number within its cell.
"""

from __future__ import annotations

import ast
import re
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import msgspec

from course.errors import UngradableError, UsageError
from course.handed_in.limits import MAX_CELLS, MAX_CODE, MAX_NOTEBOOK
from course.isolation.inside import statements
from course.printable import quoted

_FIX = "Save it from Jupyter again, or hand in the .py file."


class _Cell(msgspec.Struct, frozen=True):
    """A cell of format 4 has ``source``, one of format 3 ``input``; both may be a list of lines."""

    cell_type: str = ""
    source: str | list[str] = ""
    input: str | list[str] = ""
    id: str = ""
    metadata: dict[str, Any] = {}


class _Worksheet(msgspec.Struct, frozen=True):
    cells: list[_Cell] = []


class _Named(msgspec.Struct, frozen=True):
    language: str | None = None
    name: str | None = None


class _Metadata(msgspec.Struct, frozen=True):
    kernelspec: _Named | None = None
    language_info: _Named | None = None


class _Notebook(msgspec.Struct, frozen=True):
    nbformat: int
    cells: list[_Cell] = []
    worksheets: list[_Worksheet] = []
    metadata: _Metadata | None = None


@dataclass(frozen=True)
class CodeCell:
    """One code cell.

    Attributes:
        number: 1 is the first cell of the notebook, text cells included, as a person counts.
        text: Python, with a ``pass`` where a line was taken out.
        tree: its syntax tree; None if it is not Python.
        tags: what the course wrote into the cell's metadata when it generated it; {} where that is lost.
        dropped: lines that were taken out, (line, text) each.
        raw: its text as it is in the notebook.
        id: its id there, if it has one.
    """

    number: int
    text: str
    tree: ast.Module | None
    tags: dict[str, Any]
    dropped: tuple[tuple[int, str], ...] = field(default=())
    raw: str = ""
    id: str = ""


def code_cells(data: bytes, name: str) -> list[CodeCell]:
    """The code cells of a notebook, in its order; UngradableError if it is none, or one of another
    language."""
    if len(data) > MAX_NOTEBOOK:
        raise UngradableError(
            f"{name} is larger than {MAX_NOTEBOOK >> 20} MB.",
            help="Clear its outputs, save it, and hand it in again.",
            code="too_large",
        )
    notebook = _decoded(data, name)
    language = _language(notebook.metadata)
    if language not in {"", "python"}:
        raise UngradableError(
            f"{name} is a notebook for {quoted(language)}, not for Python.",
            help="Write the functions in a Python notebook.",
            code="other_kernel",
        )
    cells = notebook.cells or [cell for sheet in notebook.worksheets for cell in sheet.cells]
    codes = [(number, cell) for number, cell in enumerate(cells, 1) if cell.cell_type == "code"]
    _must_be_small([(number, len(_text(cell))) for number, cell in codes], name)
    return [_code_cell(number, cell) for number, cell in codes]


def typed_cell(number: int, text: str) -> CodeCell:
    """A cell of which only the text is known, because it was typed into a running notebook."""
    return _code_cell(number, _Cell("code", text))


def _must_be_small(sizes: list[tuple[int, int]], name: str) -> None:
    """Refuse too much code before it is parsed: a syntax tree is far larger than its text."""
    if len(sizes) > MAX_CELLS:
        raise UngradableError(
            f"{name} has {len(sizes):,} code cells.",
            help=f"Hand in a notebook with at most {MAX_CELLS:,}.",
            code="too_large",
        )
    if sum(size for _, size in sizes) <= MAX_CODE:
        return
    number, size = max(sizes, key=lambda one: one[1])
    raise UngradableError(
        f"The code of {name} is larger than {MAX_CODE >> 20} MB; cell {number} has {size:,} characters.",
        help="Keep data out of the cells; the exercise needs none.",
        code="too_large",
    )


def _decoded(data: bytes, name: str) -> _Notebook:
    try:
        return msgspec.json.decode(data.removeprefix(b"\xef\xbb\xbf"), type=_Notebook)
    except (msgspec.DecodeError, UnicodeDecodeError, RecursionError) as error:
        message, advice = _why_unread(data, name, error)
        raise UngradableError(message, help=advice, code="not_a_notebook") from None


#: What ``git merge`` leaves where both sides changed the same lines.
_MERGE = re.compile(rb"^(?:<{7}|={7}|>{7})(?: |\r?$)", re.MULTILINE)


def _why_unread(data: bytes, name: str, error: Exception) -> tuple[str, str]:
    """Why a file is no notebook, and what to do, in its student's words and not in a parser's."""
    if not data.strip():
        return f"{name} is empty.", f"Was it saved? {_FIX}"
    if found := _MERGE.search(data):
        line = data.count(b"\n", 0, found.start()) + 1
        message = (
            f"{name} has the marks of a merge in it, the first on line {line}, so no program can open it."
        )
        return message, "Open it in a text editor, keep one of the two versions and delete the marks."
    if isinstance(error, msgspec.ValidationError) or "truncated" not in str(error):
        at = re.search(r"\(byte (\d+)\)", str(error))
        line = data.count(b"\n", 0, int(at[1])) + 1 if at else 0
        where = f" from line {line} on" if at else ""
        return f"{name} is not a notebook: Jupyter could not read it{where} either.", _FIX
    return f"{name} ends in the middle: it was not saved, or not copied, to its end.", _FIX


def _language(metadata: _Metadata | None) -> str:
    """The language a notebook says it is in, "" if it does not say."""
    if metadata is None:
        return ""
    said = [
        metadata.language_info.name if metadata.language_info else None,
        metadata.kernelspec.language if metadata.kernelspec else None,
    ]
    words = [word.lower() for word in said if word]
    # "ipython" is what old notebooks say, and "python3" some kernels.
    return "python" if any("python" in word for word in words) else (words[0] if words else "")


def _code_cell(number: int, cell: _Cell) -> CodeCell:
    text, dropped = _without_magics(_text(cell).replace("\r\n", "\n").replace("\r", "\n"))
    text, more = statements.without_shell(text)
    tags = cell.metadata.get("course")
    tags = tags if isinstance(tags, dict) else {}
    return CodeCell(number, text, statements.tree(text), tags, (*dropped, *more), _text(cell), cell.id)


def _text(cell: _Cell) -> str:
    source = cell.source or cell.input
    return source if isinstance(source, str) else "".join(source)


# -- what IPython adds ------------------------------------------------------------------------------------


def _without_magics(text: str) -> tuple[str, tuple[tuple[int, str], ...]]:
    """The text as Python, and the lines that were taken out of it."""
    first = text.lstrip("\n").partition("\n")[0]
    if not first.startswith("%%"):
        return statements.without_magics(text)
    name = first[2:].split(maxsplit=1)[0] if first[2:].strip() else ""
    at = text.index("%%")
    line = text.count("\n", 0, at) + 1
    if name not in statements.PYTHON_MAGICS:
        return "", ((line, first),)
    rest, dropped = _without_magics(text[:at] + text[at + len(first) :])
    return rest, ((line, first), *dropped)


def read_notebook(path: Path) -> bytes:
    try:
        if not path.is_file():
            raise UsageError(f"{path} is not a file.", help="Name a notebook.", code="not_a_file")
        if path.stat().st_size > MAX_NOTEBOOK:
            raise UsageError(
                f"{path} is larger than {MAX_NOTEBOOK >> 20} MB.",
                help="Clear its outputs and save it.",
                code="too_large",
            )
        return path.read_bytes()
    except OSError as error:
        raise UsageError(
            f"{path} cannot be read ({error.strerror or error}).", help="Check its permissions."
        ) from error
