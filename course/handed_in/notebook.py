"""The graded part of a notebook: the module that its cells make up.

Cells that the course generated for an exercise say so in their metadata; where that was lost, a cell that
defines one of the exercise's functions is one of them. These count whole and in order, as if they had been
written into the module one after the other, so that the last definition of a name wins. Of all other cells
(helpers, experiments, plots) only the statements count that bind a name which the counted code uses.
"""

from __future__ import annotations

import ast
import re
import symtable
from bisect import bisect_right
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import msgspec

from course.errors import UngradableError
from course.handed_in.cells import CodeCell, code_cells
from course.printable import one_line
from course.scoring.judging.submission import Submission
from course.scoring.places import Places

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from course.catalog.models import Exercise

__all__ = ["RECORD", "SETUP", "SOLUTION", "NotebookSource", "notebook_source", "opened", "source_of"]

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
        source: the module's text, UTF-8.
        notes: parts left out, and assumptions, a sentence each.
        starts: (line of the module, number of the cell), ascending: where each cell's lines begin.
        called: the name of a cell, by its number.
    """

    source: bytes
    notes: tuple[str, ...]
    starts: tuple[tuple[int, int], ...]
    called: str = "cell {}"

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
        return f"{self.called.format(cell)}, line {line - start + 1}"


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

    Args:
        data: the file.
        name: what to call it in messages.

    Raises:
        UngradableError: it is not a notebook, is one of another language, or has none of the functions.
    """
    try:
        return source_of(code_cells(data, name), exercise, name)
    except RecursionError:
        raise UngradableError(
            f"{name} holds an expression nested too deeply to be read.",
            help="Split it into several lines.",
            code="too_deep",
        ) from None


def source_of(cells: list[CodeCell], exercise: Exercise, name: str) -> NotebookSource:
    """The module that cells stand for, however they came to be known; see ``notebook_source``."""
    functions = {task.id for task in exercise.task}
    chosen = [cell for cell in cells if _counts(cell, exercise.id, functions)]
    if not chosen:
        listed = ", ".join(task.id for task in exercise.task)
        raise UngradableError(
            f"{name} defines none of the functions of this exercise.",
            help=f"Keep the names the notebook gave: {listed}.",
            code="no_declared_functions",
        )
    blocks = _blocks(cells, chosen)
    return _written(blocks, _notes(cells, chosen, exercise.id))


def _counts(cell: CodeCell, exercise: str, functions: set[str]) -> bool:
    """Whether a cell is part of the solution as a whole."""
    if cell.tags.get("exercise") == exercise and cell.tags.get("role") in (SOLUTION, SETUP):
        return bool(cell.text.strip())
    # Also in a cell that was generated to check something: two cells that are merged keep the marks of one.
    if cell.tree is None:
        # Not Python: what it would have defined decides, so that it is refused as the module would be.
        found = re.findall(r"^(?:async )?def\s+(\w+)", cell.text, re.MULTILINE)
        return not functions.isdisjoint(found)
    return not functions.isdisjoint(name for node in cell.tree.body for name in _bound(node))


# -- statements of other cells -----------------------------------------------------------------------------


def _blocks(cells: list[CodeCell], chosen: list[CodeCell]) -> list[tuple[CodeCell, str]]:
    """(cell, text) of everything that counts, in order; lines left out are empty."""
    whole = {cell.number for cell in chosen}
    others = [
        (cell, node)
        for cell in cells
        if cell.number not in whole and cell.tree
        for node in cell.tree.body
        if not _is_tool(cell, node)
    ]
    binding: dict[str, list[int]] = {}
    for index, (_, node) in enumerate(others):
        for name in _bound(node):
            binding.setdefault(name, []).append(index)
    kept: set[int] = set()
    wanted = [name for cell in chosen if cell.tree for name in _loaded(cell.tree)]
    while wanted:
        for index in binding.pop(wanted.pop(), ()):  # each name is looked up once
            if index not in kept:
                kept.add(index)
                wanted += _loaded(others[index][1])
    nodes: dict[int, list[ast.stmt]] = {}
    for index in sorted(kept):
        nodes.setdefault(others[index][0].number, []).append(others[index][1])
    return [
        (cell, cell.text if cell.number in whole else _only(cell.text, nodes[cell.number]))
        for cell in cells
        if cell.number in whole or cell.number in nodes
    ]


def _is_tool(cell: CodeCell, node: ast.stmt) -> bool:
    """Whether a statement is there because a generated cell that checks something needs it."""
    if cell.tags.get("role") in (None, SOLUTION, SETUP):
        return False
    return isinstance(node, ast.ImportFrom) and (node.module or "").partition(".")[0] == "course"


def _bound(node: ast.AST) -> Iterator[str]:
    """Names that a statement binds at its own level, or changes: x = 1, x[0] = 1, x.append(1), def x."""
    match node:
        case ast.FunctionDef() | ast.AsyncFunctionDef() | ast.ClassDef():
            yield node.name
        case ast.Import() | ast.ImportFrom():
            for alias in node.names:
                yield (alias.asname or alias.name).partition(".")[0]
        case ast.Name(ctx=ast.Store() | ast.Del()):
            yield node.id
        case ast.Attribute(ctx=ast.Store() | ast.Del()) | ast.Subscript(ctx=ast.Store() | ast.Del()):
            yield from _base(node)
        case ast.Expr(value=ast.Call(func=ast.Attribute() as method)):
            yield from _base(method)
        case ast.Lambda() | ast.ListComp() | ast.SetComp() | ast.DictComp() | ast.GeneratorExp():
            return
        case _:
            for child in ast.iter_child_nodes(node):
                yield from _bound(child)


def _base(node: ast.expr) -> Iterator[str]:
    """The name at the root of a.b[c].d."""
    while isinstance(node, ast.Attribute | ast.Subscript):
        node = node.value
    if isinstance(node, ast.Name):
        yield node.id


def _loaded(node: ast.AST) -> Iterator[str]:
    """Every name of the module that a piece of code reads; parameters and other local names are none."""
    yield from _augmented(node)
    try:
        table = symtable.symtable(ast.unparse(node), "cell", "exec")
    except SyntaxError:  # such as a return outside of a function: the names it reads are unknown
        yield from (child.id for child in ast.walk(node) if isinstance(child, ast.Name))
    else:
        yield from _global(table)


def _global(table: symtable.SymbolTable) -> Iterator[str]:
    """Names that a scope and those within it take from the module."""
    outermost = table.get_type() == "module"
    for symbol in table.get_symbols():
        if symbol.is_referenced() if outermost else symbol.is_global():
            yield symbol.get_name()
    for child in table.get_children():
        yield from _global(child)


def _augmented(node: ast.AST) -> Iterator[str]:
    """Names that are changed from what they were, at the level of the module: x += 1."""
    if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef | ast.Lambda):
        return
    if isinstance(node, ast.AugAssign):
        yield from _base(node.target)
    for child in ast.iter_child_nodes(node):
        yield from _augmented(child)


def _only(text: str, nodes: list[ast.stmt]) -> str:
    """The lines of some statements of a cell; the lines of all others are empty."""
    lines = text.split("\n")
    shown = [""] * len(lines)
    for node in nodes:
        decorators = getattr(node, "decorator_list", [])
        first = min([node.lineno, *(decorator.lineno for decorator in decorators)])
        shown[first - 1 : node.end_lineno] = lines[first - 1 : node.end_lineno]
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


def _notes(cells: list[CodeCell], chosen: list[CodeCell], exercise: str) -> tuple[str, ...]:
    dropped = [
        (cell.number, line, text)
        for cell in cells
        if cell.tags.get("role") in (None, SOLUTION, SETUP)
        for line, text in cell.dropped
    ]
    notes = [
        f"Cell {number}, line {line}: left out, since it is not Python: {one_line(text, 80)}"
        for number, line, text in dropped[:MAX_NOTES]
    ]
    if len(dropped) > MAX_NOTES:
        notes.append(f"{len(dropped) - MAX_NOTES:,} more lines were left out, since they are not Python.")
    unmarked = [str(cell.number) for cell in chosen if cell.tags.get("exercise") != exercise]
    if unmarked:
        numbers = ", ".join(unmarked[:MAX_NOTES]) + (" and more" if len(unmarked) > MAX_NOTES else "")
        notes.append(f"Taken for part of the solution by what they define: cells {numbers}.")
    return tuple(notes)
