"""The answers of known wrong programs to an exercise's questions: ``hypotheses.json``, made by a command.

The file is part of the exercise, so that a diagnosis at home is as good as in a grading run. It contains
nothing that solves the exercise: only fingerprints, and the answers to public checks with fixed inputs.
"""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, Any

import msgspec

from course.errors import ContentError
from course.scoring.explain.fingerprint import SAME

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

__all__ = ["FILE", "Row", "Table", "matching", "read_table", "write_table"]

FILE = "hypotheses.json"


class Row(msgspec.Struct, frozen=True, array_like=True):
    """One wrong program: the codes of its mistakes, and its answers.

    Attributes:
        codes: one for each mistake.
        sums: its fingerprint, or the answers themselves where a task is compared within a tolerance.
    """

    codes: tuple[str, ...]
    sums: tuple[float, ...]


class Table(msgspec.Struct, frozen=True, kw_only=True):
    """``hypotheses.json``.

    Attributes:
        format_version: of this file.
        made_from: digest of what it was computed from.
        within: relative tolerance of the tasks whose answers are stored directly.
        rows: by task; programs with one mistake come first.
        right: fingerprints of right programs, by task.
        answers: those that public checks with fixed inputs expect, by check and in its order.
    """

    format_version: int = 1
    made_from: str = ""
    within: dict[str, float] = {}
    rows: dict[str, tuple[Row, ...]] = {}
    right: dict[str, tuple[tuple[float, ...], ...]] = {}
    answers: dict[str, list[Any]] = {}


@cache
def read_table(path: Path) -> Table:
    """The table of an exercise.

    Raises:
        ContentError: there is none, or it is damaged.
    """
    try:
        return msgspec.json.decode(path.read_bytes(), type=Table)
    except (OSError, msgspec.DecodeError) as error:
        raise ContentError(
            path, None, f"what wrong programs answer cannot be read: {error}.", help="`course author build`"
        ) from None


def write_table(path: Path, table: Table) -> None:
    """Write the table, one row a line."""
    text = msgspec.json.format(msgspec.json.encode(table), indent=0).decode()
    path.write_text(text.replace("\n", "").replace("]],[[", "]],\n[[") + "\n", encoding="utf-8")


def matching(table: Table, task: str, sums: Sequence[float]) -> tuple[Row, ...]:
    """The programs with these sums, and of these only the ones with the fewest mistakes."""
    within = table.within.get(task, 0.0)
    fits = [row for row in table.rows.get(task, ()) if _same(row.sums, sums, within)]
    fewest = min((len(row.codes) for row in fits), default=0)
    return tuple(row for row in fits if len(row.codes) == fewest)


def is_right(table: Table, task: str, sums: Sequence[float]) -> bool:
    """Whether a right program has these sums."""
    within = table.within.get(task, 0.0)
    return any(_same(right, sums, within) for right in table.right.get(task, ()))


def _same(a: Sequence[float], b: Sequence[float], within: float) -> bool:
    if len(a) != len(b):
        return False
    if not within:
        return all(abs(x - y) <= SAME for x, y in zip(a, b, strict=True))
    return all(x == y or abs(x - y) <= within * max(abs(x), abs(y)) for x, y in zip(a, b, strict=True))
