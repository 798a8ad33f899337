"""Merge a newer notebook with a student's work in the older one.

Every generated cell has its slot and the digest of its original text. A cell whose text no longer matches its
digest was edited; one without a slot was added by the student. Edited and added cells stay where they are,
with their outputs; all others are replaced by the newer notebook's. A cell that the course changed, too,
stands above the student's, but for a function or an answer: there the student's cell stays alone. Where that
is not safe, nothing is merged, and the reason is given.
"""

import ast
import contextlib
import json
from dataclasses import dataclass
from typing import Any

from course.notebooks.cells import digest, dumped

RawCell = dict[str, Any]
#: What a student fills in: two of them would be one too many.
_FILLED_IN = frozenset({"solution", "warm-up", "prediction"})


class CannotMergeError(Exception):
    """Two notebooks cannot be merged; the message says why."""


def is_untouched(data: bytes) -> bool:
    """Whether a notebook holds no student's work: it was generated, and at most run since."""
    try:
        cells = [_Held(cell) for cell in _read(data)["cells"]]
    except CannotMergeError:
        return False
    slots = [cell.slot for cell in cells]
    return all(slots) and len(set(slots)) == len(slots) and not any(cell.edited for cell in cells)


def worked_in(data: bytes, exercise: str) -> bool:
    """Whether a notebook was generated for an exercise, whatever its file is called, and was edited since."""
    with contextlib.suppress(CannotMergeError):
        match _read(data)["metadata"].get("course"):
            case {"kind": "exercise", "id": name}:
                return bool(name == exercise) and not is_untouched(data)
    return False


def merged(old: bytes, new: bytes) -> bytes:
    """The newer notebook with the student's work from the older one; ``old`` itself if nothing is newer.

    Args:
        old: the file as it is, edited and run.
        new: the file as it is generated now.

    Raises:
        CannotMergeError: the old one is another notebook or none, its cells stand in another order, or the
            course changed the parameters of a function that the student wrote.
    """
    before, after = _read(old), _read(new)
    about = before.get("metadata", {}).get("course")
    theirs = after["metadata"]["course"]
    if not isinstance(about, dict) or (about.get("kind"), about.get("id")) != (theirs["kind"], theirs["id"]):
        raise CannotMergeError("it does not say that it is this notebook")
    cells = _woven([_Held(cell) for cell in before["cells"]], [_Held(cell) for cell in after["cells"]])
    metadata = {**before["metadata"], "course": theirs}
    # Fields that are not read here, such as a newer minor format, come from the student's file.
    result = {**before, "metadata": metadata, "cells": _with_own_ids(cells)}
    return old if result == before else dumped(result)


@dataclass
class _Held:
    cell: RawCell

    @property
    def source(self) -> str:
        source = self.cell.get("source", "")
        return source if isinstance(source, str) else "".join(source)

    @property
    def tags(self) -> dict[str, Any]:
        tags = self.cell.get("metadata", {}).get("course")
        return tags if isinstance(tags, dict) else {}

    @property
    def slot(self) -> str:
        return str(self.tags.get("slot", ""))

    @property
    def made(self) -> str:
        """The digest of the cell's original text."""
        return str(self.tags.get("made", ""))

    @property
    def is_code(self) -> bool:
        return self.cell.get("cell_type") == "code"

    @property
    def edited(self) -> bool:
        return digest(self.cell.get("cell_type", ""), self.source, self.tags) != self.made


def _woven(old: list[_Held], new: list[_Held]) -> list[RawCell]:
    """The cells of both, in the order of the new ones; added cells follow the same cell as before."""
    known = {cell.slot for cell in new}
    kept: dict[str, _Held] = {}
    own: dict[str, list[_Held]] = {}
    anchor = ""
    for cell in old:
        if cell.slot in known and cell.slot not in kept:
            kept[cell.slot] = cell
            anchor = cell.slot
        elif not cell.slot or cell.edited or cell.slot in kept:
            own.setdefault(anchor, []).append(cell)
    before = [slot for slot, cell in kept.items() if cell.is_code]
    if before != [cell.slot for cell in new if cell.slot in kept and kept[cell.slot].is_code]:
        raise CannotMergeError("its cells stand in another order")
    cells = [cell.cell for cell in own.get("", [])]
    for cell in new:
        cells += _either(kept.get(cell.slot), cell)
        cells += [mine.cell for mine in own.get(cell.slot, [])]
    return cells


def _either(old: _Held | None, new: _Held) -> list[RawCell]:
    """The cell that goes into one slot."""
    if old is None:
        return [new.cell]
    if not old.edited:
        # Outputs are kept, unless the newer cell comes with its own.
        same = old.made == new.made and not new.cell.get("outputs")
        return [{**old.cell, "metadata": {**old.cell["metadata"], "course": new.tags}} if same else new.cell]
    if old.made == new.made or old.source == new.source:
        return [old.cell]
    if new.tags.get("role") not in _FILLED_IN or not new.is_code:
        # The second cell with the same slot counts as the student's own from now on.
        return [new.cell, old.cell]
    mine, theirs = _parameters(old), _parameters(new)
    if None not in (mine, theirs) and mine != theirs:
        raise CannotMergeError(f"the course changed the parameters of a function that you wrote ({new.slot})")
    return [{**old.cell, "metadata": {**old.cell["metadata"], "course": new.tags}}]


def _parameters(cell: _Held) -> list[str] | None:
    """Those of the function that a cell is for; None if it does not define it, or is no Python."""
    try:
        body = ast.parse(cell.source).body
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return None
    for node in body:
        if isinstance(node, ast.FunctionDef) and node.name == cell.tags.get("task"):
            given = node.args
            return [one.arg for one in (*given.posonlyargs, *given.args, *given.kwonlyargs)]
    return None


def _with_own_ids(cells: list[RawCell]) -> list[RawCell]:
    """The cells with unique ids: Jupyter would replace a duplicate by a random one."""
    seen: set[str] = set()
    written = []
    for cell in cells:
        name = str(cell.get("id") or digest(cell.get("cell_type", ""), _Held(cell).source, {}))
        number, chosen = 1, name
        while chosen in seen:
            number += 1
            chosen = f"{name}-{number}"
        seen.add(chosen)
        written.append({**cell, "id": chosen})
    return written


def _read(data: bytes) -> dict[str, Any]:
    """A notebook of format 4 as plain data."""
    try:
        notebook = json.loads(data.decode("utf-8-sig"))
    except (ValueError, RecursionError):
        raise CannotMergeError("it cannot be read as a notebook") from None
    match notebook:
        case {"nbformat": 4, "metadata": dict(), "cells": list(cells)} if all(
            isinstance(cell, dict) and isinstance(cell.get("metadata", {}), dict) for cell in cells
        ):
            return dict(notebook)
    raise CannotMergeError("it is not a notebook of format 4")
