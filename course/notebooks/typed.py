"""The code that a student has in a notebook: what its file holds, or would hold if it were saved now.

What is handed in is the file, so a check judges the file: its cells in their order, whatever else the kernel
has run. Cells that were run after the file was saved take the place of what it has of them. Where the file is
not known, the cells that were run are all there is.
"""

from __future__ import annotations

import ast
import contextlib
import os
import re
import time
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from course.errors import CourseError
from course.handed_in.cells import CodeCell, code_cells, read_notebook, typed_cell
from course.handed_in.notebook import SETUP, NotebookSource, source_of
from course.notebooks.building.stub import pieces

if TYPE_CHECKING:
    from collections.abc import Sequence

    from course.catalog.models import Exercise

__all__ = ["Run", "Runs", "at_hand", "defines_all", "given", "module_of", "typed_in"]

_DEF = re.compile(r"^(?:async\s+)?def\s+(\w+)|^class\s+(\w+)", re.MULTILINE)
#: Cells that are not in the file get numbers from here on.
_UNSAVED = 1_000_000


@dataclass(frozen=True)
class Run:
    """A cell that was run.

    Attributes:
        number: as the notebook shows it: In [5].
        cell: its id, where the notebook's program tells it.
        at: seconds since 1970; 0 if it was not seen.
    """

    number: int
    text: str
    cell: str = ""
    at: float = 0.0


class Runs:
    """The cells that a shell runs from now on, and those that were deleted meanwhile.

    Args:
        shell: of IPython.
    """

    def __init__(self, shell: Any) -> None:
        self._shell = shell
        self._seen: dict[int, Run] = {}
        self.deleted: dict[str, float] = {}
        shell.events.register("pre_run_cell", self._before)

    def _before(self, info: Any) -> None:
        now = time.time()
        if info.store_history:
            number = len(self._shell.history_manager.input_hist_raw)  # it is put there next
            self._seen[number] = Run(number, info.raw_cell, str(getattr(info, "cell_id", None) or ""), now)
        with contextlib.suppress(Exception):  # what a program says beside a cell may have any form
            told = self._shell.get_parent().get("metadata", {}).get("deletedCells", ())
            self.deleted.update(dict.fromkeys(map(str, told), now))

    def so_far(self) -> list[Run]:
        """All cells that were run, oldest first, without the current one."""
        texts = typed_in(self._shell)
        return [self._seen.get(number, Run(number, text)) for number, text in enumerate(texts, 1)]


def typed_in(shell: Any) -> list[str]:
    """The cells that were run in a shell so far, oldest first, without the current one."""
    return list(shell.history_manager.input_hist_raw[1:-1])


def at_hand(shell: Any, exercise: Exercise) -> NotebookSource:
    """The module that the notebook of a shell makes up.

    Raises:
        UngradableError: it has none of the exercise's functions.
    """
    seen: Runs | None = getattr(shell, "course_runs", None)
    runs = seen.so_far() if seen else [Run(n, text) for n, text in enumerate(typed_in(shell), 1)]
    path = _file_of(shell, exercise, runs)
    if path is not None:
        with contextlib.suppress(CourseError, OSError):
            saved, at = code_cells(read_notebook(path), path.name), path.stat().st_mtime
            deleted = {cell for cell, when in seen.deleted.items() if when > at} if seen else set()
            kept = [cell for cell in saved if cell.id not in deleted or not cell.id]
            return _as_saved_now(kept, at, runs, exercise, path.name)
    return module_of([run.text for run in runs], exercise)


def _file_of(shell: Any, exercise: Exercise, runs: Sequence[Run]) -> Path | None:
    """The file of the notebook that a shell belongs to, as its program tells it; or the likely one."""
    told = os.environ.get("JPY_SESSION_NAME"), shell.user_ns.get("__vsc_ipynb_file__")
    with contextlib.suppress(OSError, ValueError):
        for name in told:
            if isinstance(name, str) and name.endswith(".ipynb") and Path(name).is_file():
                return Path(name)
        likely = Path(exercise.module).with_suffix(".ipynb")
        texts = {run.text.strip() for run in runs} - {""}
        if likely.is_file():
            with contextlib.suppress(CourseError):
                there = {cell.raw.strip() for cell in code_cells(read_notebook(likely), likely.name)}
                return likely if 2 * len(texts & there) >= len(texts) else None
    return None


def _as_saved_now(
    saved: list[CodeCell], at: float, runs: Sequence[Run], exercise: Exercise, name: str
) -> NotebookSource:
    """The module of a file, with what was run after it was saved.

    Args:
        saved: its cells.
        at: when it was saved, s since 1970.
    """
    last, new = _placed(saved, at, runs)
    cells: list[CodeCell] = []
    called: dict[int, str] = {}
    unsaved: list[str] = []
    changed: list[str] = []
    for index, cell in enumerate(saved):
        run = last.get(index)
        if run is not None and run.text.strip() == cell.raw.strip():
            called[cell.number] = f"In [{run.number}]"
        elif run is not None and run.at > at:
            called[cell.number] = f"In [{run.number}]"
            unsaved.append(called[cell.number])
            cells.append(replace(typed_cell(cell.number, run.text), tags=cell.tags))
            continue
        elif run is not None and _names(cell):
            changed.append(f"In [{run.number}]")
        cells.append(cell)
    for run in new:
        number = _UNSAVED + run.number
        called[number] = f"In [{run.number}]"
        unsaved.append(called[number])
        cells.append(typed_cell(number, run.text))
    module = source_of(cells, exercise, name, called)
    notes = list(module.notes)
    if unsaved:
        notes.append(
            f"{name} is not saved as you ran it: {_listed(unsaved)}. This check took what you ran. What is"
            " handed in is the file, so save it."
        )
    if changed:
        notes.append(
            f"Changed since you ran it: {_listed(changed)}. This check took it as it is in the file now."
        )
    return replace(module, notes=tuple(notes))


def _placed(saved: list[CodeCell], at: float, runs: Sequence[Run]) -> tuple[dict[int, Run], list[Run]]:
    """The last run of each cell of a file, and runs of cells that it does not have yet."""
    ids = {cell.id: index for index, cell in enumerate(saved) if cell.id}
    texts = {cell.raw.strip(): index for index, cell in enumerate(saved)}
    defining = {name: index for index, cell in enumerate(saved) for name in _names(cell)}
    last: dict[int, Run] = {}
    new: dict[str, Run] = {}
    for run in runs:
        text, names = run.text.strip(), _names(typed_cell(1, run.text))
        index = ids.get(run.cell, texts.get(text))
        if index is None and not (run.cell and ids):
            index = next((defining[name] for name in sorted(names) if name in defining), None)
        if index is not None:
            last[index] = run
        elif run.at > at and text:
            new[run.cell or text] = run
    return last, list(new.values())


def _listed(cells: list[str]) -> str:
    return ", ".join(cells[:5]) + (f" and {len(cells) - 5} more" if cells[5:] else "")


def module_of(history: Sequence[str], exercise: Exercise) -> NotebookSource:
    """The module that the cells that were run make up, where there is no file of them.

    Only the newest version of a cell counts: one is left out once everything it defined has been defined
    again.

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
        names = _names(cell) or {cell.raw.strip()}
        if names <= later:
            continue
        later |= names
        kept.append(cell)
    called = {cell.number: f"In [{cell.number}]" for cell in cells}
    return source_of(kept[::-1], exercise, "This notebook", called)


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
