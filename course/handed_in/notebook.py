"""A notebook that was handed in: its code cells as plain Python, and the module that these make up.

A notebook is read as data: nothing of it runs, and its outputs are skipped. What IPython adds to Python is
taken out line by line, so that every other line keeps its number within its cell.

Of every cell those statements count that bind a name which the exercise's functions use; where a cell was
generated for an exercise, or defines one of its functions, all that it defines, imports and assigns counts.
Whatever else stands in a cell (plots, prints, tries) takes no part. A later definition of a name replaces an
earlier one. A cell that is no Python costs what it would have defined, and nothing else.
"""

from __future__ import annotations

import ast
import re
from bisect import bisect_right
from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import msgspec

from course.catalog.models import Exercise
from course.errors import UngradableError
from course.handed_in.limits import MAX_CELLS, MAX_CODE, MAX_NOTEBOOK
from course.isolation.inside import statements
from course.printable import counted, one_line, quoted
from course.scoring.judging.submission import Submission
from course.scoring.verdict import Places

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
    """The code cells of a notebook, in its order.

    Raises:
        UngradableError: it is not a notebook, or one of another language.
    """
    if len(data) > MAX_NOTEBOOK:
        message = f"{name} is larger than {MAX_NOTEBOOK >> 20} MB."
        advice = "Clear its outputs, save it, and hand it in again."
        raise UngradableError(message, help=advice, code="too_large")
    notebook = _decoded(data, name)
    language = _language(notebook.metadata)
    if language not in {"", "python"}:
        message = f"{name} is a notebook for {quoted(language)}, not for Python."
        raise UngradableError(message, help="Write the functions in a Python notebook.", code="other_kernel")
    cells = notebook.cells or [cell for sheet in notebook.worksheets for cell in sheet.cells]
    codes = [(n, cell) for n, cell in enumerate(cells, 1) if cell.cell_type == "code" or _was_code(cell)]
    _must_be_small([(number, len(_text(cell))) for number, cell in codes], name)
    return [_code_cell(number, cell) for number, cell in codes]


def typed_cell(number: int, text: str) -> CodeCell:
    """A cell of which only the text is known, because it was typed into a running notebook."""
    return _code_cell(number, _Cell("code", text))


def _must_be_small(sizes: list[tuple[int, int]], name: str) -> None:
    """Refuse too much code before it is parsed: a syntax tree is far larger than its text."""
    if len(sizes) > MAX_CELLS:
        advice = f"Hand in a notebook with at most {MAX_CELLS:,}."
        raise UngradableError(f"{name} has {len(sizes):,} code cells.", help=advice, code="too_large")
    if sum(size for _, size in sizes) <= MAX_CODE:
        return
    number, size = max(sizes, key=lambda one: one[1])
    message = f"The code of {name} is larger than {MAX_CODE >> 20} MB; cell {number} has {size:,} characters."
    advice = "Keep data out of the cells; the exercise needs none."
    raise UngradableError(message, help=advice, code="too_large")


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


def _was_code(cell: _Cell) -> bool:
    """Whether it was made for a function, and is a text cell now: in Jupyter the key M is all it takes."""
    tags = cell.metadata.get("course")
    return isinstance(tags, dict) and tags.get("role") == SOLUTION


def _code_cell(number: int, cell: _Cell) -> CodeCell:
    if cell.cell_type != "code":
        left_out = ((1, "it is a text cell, and the key Y makes it one of code"),)
        return CodeCell(
            number, "", statements.tree(""), cell.metadata["course"], left_out, _text(cell), cell.id
        )
    text, dropped = _without_magics(_text(cell).replace("\r\n", "\n").replace("\r", "\n"))
    text, more = statements.without_shell(text)
    tags = cell.metadata.get("course")
    tags = tags if isinstance(tags, dict) else {}
    return CodeCell(number, text, statements.tree(text), tags, (*dropped, *more), _text(cell), cell.id)


def _text(cell: _Cell) -> str:
    source = cell.source or cell.input
    return source if isinstance(source, str) else "".join(source)


def _not_python(cells: list[CodeCell], functions: Collection[str]) -> CodeCell | None:
    """The first cell with one of the functions that a magic such as ``%%writefile`` takes out whole."""
    named = re.compile(rf"(?m)^\s*def\s+({'|'.join(map(re.escape, functions))})\b")
    return next((cell for cell in cells if not cell.text and cell.dropped and named.search(cell.raw)), None)


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


# -- the module ----------------------------------------------------------------------------------------------

#: Roles that the course gives cells it generates.
SOLUTION, SETUP = "solution", "setup"
#: Under this name a submission says which cells its module was made of.
RECORD = "notebook.json"
#: Lines that are named, of those left out; the rest is a number.
MAX_NOTES = 20


class _Record(msgspec.Struct, frozen=True):
    """Facts about a notebook that are stored beside its module."""

    notes: tuple[str, ...]
    starts: tuple[tuple[int, int], ...]


@dataclass(frozen=True)
class NotebookSource(Places):
    """A notebook as a module.

    Attributes:
        notes: parts left out, and assumptions, a sentence each.
        starts: (line of the module, number of the cell), ascending: where each cell's lines begin.
        called: names of cells by their numbers, for those that are not called "cell 7".
    """

    source: bytes
    notes: tuple[str, ...]
    starts: tuple[tuple[int, int], ...]
    called: Mapping[int, str] = field(default_factory=dict)

    def record(self) -> bytes:
        """Notes and places as bytes, to store beside the module."""
        return msgspec.json.encode({"notes": self.notes, "starts": self.starts})

    @classmethod
    def of(cls, source: bytes, record: bytes) -> NotebookSource:
        """A module and its ``record`` put together again."""
        kept = msgspec.json.decode(record, type=_Record)
        return cls(source=source, notes=kept.notes, starts=kept.starts)

    def submission(self, exercise: Exercise) -> Submission:
        """The module to be graded; its lines are reported as cells."""
        return Submission({exercise.module: self.source}, replace(self, module=exercise.module), self.notes)

    def phrase(self, line: int) -> str:
        """A line within a sentence: "in cell 7, line 3 of your notebook"."""
        return f"in {self.place(line)} of your notebook"

    def heading(self, line: int) -> str:
        """A line at the head of a message: "Cell 7, line 3"."""
        place = self.place(line)
        return place[:1].upper() + place[1:]

    def trace(self, text: str) -> str:
        """The student's frames with cells in place of lines."""
        return _IN_TRACE.sub(lambda match: f"{self.place(int(match[1]))} in ", text)

    def place(self, line: int) -> str:
        """A line of the module as a place in the notebook: "cell 7, line 3"."""
        index = bisect_right(self.starts, (line, 1 << 30)) - 1
        if index < 0:
            return f"line {line}"
        start, cell = self.starts[index]
        return f"{self.called.get(cell, f'cell {cell}')}, line {line - start + 1}"


#: How a student's frame begins in a traceback, as ``StudentFailure`` has it.
_IN_TRACE = re.compile(r"^\S+:(\d+) in ", re.MULTILINE)


def opened(files: Mapping[str, bytes], exercise: Exercise) -> Submission:
    """The submission, ready for grading; with a notebook's ``RECORD``, messages name its cells."""
    record = files.get(RECORD)
    if record is None:
        return Submission(files)
    return NotebookSource.of(files[exercise.module], record).submission(exercise)


def notebook_source(data: bytes, exercise: Exercise, name: str = "the notebook") -> NotebookSource:
    """The module of a notebook.

    Raises:
        UngradableError: it is not a notebook, is one of another language, or has none of the functions.
    """
    try:
        return source_of(code_cells(data, name), exercise, name)
    except RecursionError:
        message = f"{name} holds an expression nested too deeply to be read."
        raise UngradableError(message, help="Split it into several lines.", code="too_deep") from None


def source_of(
    cells: list[CodeCell], exercise: Exercise, name: str, called: Mapping[int, str] | None = None
) -> NotebookSource:
    """The module that cells stand for, however they came to be known; see ``notebook_source``.

    Args:
        called: names of cells by their numbers, for those that are not called "cell 7".
    """
    functions = {task.id for task in exercise.task}
    chosen = [cell for cell in cells if _counts(cell, exercise.id, functions)]
    if not chosen:
        listed = ", ".join(task.id for task in exercise.task)
        if held := _not_python(cells, functions):
            line = quoted(held.dropped[0][1].strip())
            message = (
                f"{name} has its code in cell {held.number}, which begins with {line}: it is no Python cell."
            )
            advice = (
                "Delete that line, so that the cell defines the functions, and hand the notebook in again."
            )
            raise UngradableError(message, help=advice, code="no_declared_functions")
        if not any(cell.text.strip() for cell in cells):
            advice = "Was it saved after you wrote it? `course notebook build` makes a new one."
            raise UngradableError(f"{name} has no code in it.", help=advice, code="no_declared_functions")
        message = f"{name} defines none of the functions of this exercise."
        advice = f"Keep the names the notebook gave: {listed}."
        raise UngradableError(message, help=advice, code="no_declared_functions")
    names = {cell.number: f"cell {cell.number}" for cell in cells} | dict(called or {})
    notes = _notes(cells, chosen, exercise, names)
    return replace(_written(_blocks(cells, chosen, functions), notes), called=dict(called or {}))


def _counts(cell: CodeCell, exercise: str, functions: set[str]) -> bool:
    """Whether a cell belongs to the solution: all that it defines counts."""
    if cell.tags.get("exercise") == exercise and cell.tags.get("role") in (SOLUTION, SETUP):
        return bool(cell.text.strip())
    # Also in a cell that was generated to check something: two cells that are merged keep the marks of one.
    return not functions.isdisjoint(_names(cell))


def _names(cell: CodeCell) -> set[str]:
    """What a cell defines, or would define if it were Python."""
    if cell.tree is None:
        return set(statements.defined_in(cell.text))
    return {name for node in cell.tree.body for name in statements.bound(node)}


# -- what counts of the cells ------------------------------------------------------------------------------

#: What counts in a solution's cell whether or not anything needs it.
_DEFINITIONS = (
    ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef, ast.Import, ast.ImportFrom, ast.Assign,
    ast.AnnAssign, ast.AugAssign,
)  # fmt: skip


@dataclass(frozen=True)
class _Part:
    """A statement of a cell, or some lines of it that are no Python."""

    cell: CodeCell
    first: int
    last: int
    node: ast.stmt | None
    names: tuple[str, ...] = ()


def _parts(cell: CodeCell) -> Iterator[_Part]:
    if cell.tree is not None:
        yield from (_part(cell, node) for node in cell.tree.body)
        return
    found = statements.pieces(cell.text)
    ends = [*(piece.line - 1 for piece in found[1:]), cell.text.count("\n") + 1][: len(found)]
    for piece, end in zip(found, ends, strict=True):
        if piece.error is not None:
            yield _Part(cell, piece.line, end, None, piece.names)
        yield from (_part(cell, node) for node in piece.body)


def _part(cell: CodeCell, node: ast.stmt) -> _Part:
    decorators = getattr(node, "decorator_list", [])
    first = min([node.lineno, *(decorator.lineno for decorator in decorators)])
    return _Part(cell, first, node.end_lineno or node.lineno, node)


def _blocks(cells: list[CodeCell], chosen: list[CodeCell], functions: set[str]) -> list[tuple[CodeCell, str]]:
    """(cell, text) of everything that counts, in order; lines left out are empty."""
    solution = {cell.number for cell in chosen}
    parts = [
        part for cell in cells for part in _parts(cell) if part.node is None or not _is_tool(cell, part.node)
    ]
    whole = [part for part in parts if part.node is not None]
    nodes = [part.node for part in whole if part.node is not None]
    always = [
        index
        for index, part in enumerate(whole)
        if part.cell.number in solution and isinstance(part.node, _DEFINITIONS)
    ]
    kept = [whole[index] for index in statements.needed(nodes, functions, always)]
    wanted = functions.union(*(statements.loaded(part.node) for part in kept if part.node is not None))
    broken = [
        part
        for part in parts
        if part.node is None and (part.cell.number in solution or not wanted.isdisjoint(part.names))
    ]
    lines: dict[int, list[_Part]] = {}
    for part in (*kept, *broken):
        lines.setdefault(part.cell.number, []).append(part)
    return [(cell, _only(cell.text, lines[cell.number])) for cell in cells if cell.number in lines]


def _is_tool(cell: CodeCell, node: ast.stmt) -> bool:
    """Whether a statement is there because a generated cell that checks something needs it."""
    if cell.tags.get("role") in (None, SOLUTION, SETUP):
        return False
    return isinstance(node, ast.ImportFrom) and (node.module or "").partition(".")[0] == "course"


def _only(text: str, parts: list[_Part]) -> str:
    """The lines of some parts of a cell; the lines of all others are empty."""
    lines = text.split("\n")
    shown = [""] * len(lines)
    for part in parts:
        shown[part.first - 1 : part.last] = lines[part.first - 1 : part.last]
    return "\n".join(shown)


# -- the module --------------------------------------------------------------------------------------------

_FUTURE = re.compile(r"^from __future__ import .*$", re.MULTILINE)


def _written(blocks: Iterable[tuple[CodeCell, str]], notes: tuple[str, ...]) -> NotebookSource:
    """The blocks one after the other; ``from __future__`` must come first, so it is moved there."""
    futures: list[str] = []
    parts: list[str] = []
    starts: list[tuple[int, int]] = []
    line = 1
    for cell, text in blocks:
        found = _FUTURE.findall(text) if cell.tree and _imports_future(cell.tree) else []
        futures += found
        body = _FUTURE.sub("pass", text) if found else text
        starts.append((line, cell.number))
        parts.append(body)
        line += body.count("\n") + 1
    head = list(dict.fromkeys(futures))
    source = "\n".join([*head, *parts]) + "\n"
    shifted = tuple((start + len(head), number) for start, number in starts)
    return NotebookSource(source.encode("utf-8", "replace"), notes, shifted)


def _imports_future(tree: ast.Module) -> bool:
    return any(isinstance(node, ast.ImportFrom) and node.module == "__future__" for node in tree.body)


def _notes(
    cells: list[CodeCell], chosen: list[CodeCell], exercise: Exercise, names: Mapping[int, str]
) -> tuple[str, ...]:
    dropped = [
        (names[cell.number], line, text)
        for cell in cells
        if cell.tags.get("role") in (None, SOLUTION, SETUP)
        for line, text in cell.dropped
        if not text.startswith("%course_")  # a check or a hint that was asked for
    ]
    notes = [
        f"{where[:1].upper()}{where[1:]}, line {line}: left out, since it is not Python: {one_line(text, 80)}"
        for where, line, text in dropped[:MAX_NOTES]
    ]
    if len(dropped) > MAX_NOTES:
        notes.append(f"{counted(len(dropped) - MAX_NOTES, 'more line')} left out: not Python.")
    unmarked = [names[cell.number] for cell in chosen if cell.tags.get("exercise") != exercise.id]
    if unmarked:
        notes.append(f"Taken for part of the solution by what they define: {_listed(unmarked)}.")
    return (*notes, *_twice(cells, exercise, names))


def _listed(names: list[str]) -> str:
    return ", ".join(names[:MAX_NOTES]) + (" and more" if len(names) > MAX_NOTES else "")


def _twice(cells: list[CodeCell], exercise: Exercise, names: Mapping[int, str]) -> Iterator[str]:
    """Which functions are defined in more than one cell."""
    defined: dict[str, list[str]] = {task.id: [] for task in exercise.task}
    for cell in cells:
        for name in _names(cell) & defined.keys():
            defined[name].append(names[cell.number])
    for name, where in defined.items():
        if len(where) > 1:
            yield f"`{name}` is defined more than once, in {_listed(where)}; the last of them counts."
