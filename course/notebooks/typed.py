"""The code that a student has run in a notebook so far, as a module.

A kernel knows every cell that was run, old versions included, in order. Only the newest version counts: a
cell is left out once everything it defined has been defined again.
"""

from __future__ import annotations

import ast
import re
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from course.handed_in.cells import CodeCell, typed_cell
from course.handed_in.notebook import SETUP, NotebookSource, source_of
from course.notebooks.building.stub import pieces

if TYPE_CHECKING:
    from collections.abc import Sequence

    from course.catalog.models import Exercise

__all__ = ["defines_all", "given", "module_of", "typed_in"]

_DEF = re.compile(r"^(?:async\s+)?def\s+(\w+)|^class\s+(\w+)", re.MULTILINE)


def typed_in(shell: Any) -> list[str]:
    """The cells that were run in a shell so far, oldest first, without the current one."""
    return list(shell.history_manager.input_hist_raw[1:-1])


def module_of(history: Sequence[str], exercise: Exercise) -> NotebookSource:
    """The module that the cells so far make up.

    Args:
        history: what was run, oldest first, magics included.

    Raises:
        UngradableError: none of the exercise's functions was run yet.
    """
    marks = given(exercise)
    cells = [
        replace(typed_cell(number, text), tags=marks.get(text.strip(), {}))
        for number, text in enumerate(history, 1)
        if text.strip()
    ]
    kept: list[CodeCell] = []
    later: set[str] = set()
    for cell in reversed(cells):
        names = _names(cell)
        if names and names <= later:
            continue
        later |= names
        kept.append(cell)
    return replace(source_of(kept[::-1], exercise, "This notebook"), called="In [{}]")


def given(exercise: Exercise) -> dict[str, dict[str, str]]:
    """The metadata of the cells in an exercise's original notebook, by their text.

    A kernel does not see metadata; and an import in such a cell counts whether it is used or not.
    """
    parts = pieces(exercise.stub_path.read_text(encoding="utf-8"), {task.id for task in exercise.task})[1]
    marks = {"exercise": exercise.id, "role": SETUP}
    return {part.text.strip(): marks for part in parts if not part.task}


def defines_all(source: bytes, names: Sequence[str]) -> bool:
    """Whether a module defines every name. True for text that is not Python: it cannot run anyway."""
    tree = typed_cell(1, source.decode()).tree
    if tree is None:
        return True
    assigned = {
        node.id for node in ast.walk(tree) if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store)
    }
    defined = {node.name for node in tree.body if isinstance(node, ast.FunctionDef | ast.ClassDef)}
    return set(names) <= defined | assigned


def _names(cell: CodeCell) -> set[str]:
    """The functions and classes that a cell defines, or would define if its syntax were right."""
    if cell.tree is None:
        return {first or second for first, second in _DEF.findall(cell.text)}
    return {
        node.name
        for node in cell.tree.body
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef)
    }
