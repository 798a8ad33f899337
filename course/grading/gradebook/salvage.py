"""A new gradebook from a damaged one: every intact row, from the file itself and from its backups.

A row is intact if the digest at its end matches, wherever it was found. So neither the file's header nor its
order matters, and damaged rows are left out. An override is in the gradebook twice, among the overrides and
in the journal, on pages that are not the same.
"""

from __future__ import annotations

import contextlib
import hashlib
import shutil
import sqlite3
from collections import Counter
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import msgspec

from course.errors import IntegrityError, NotFoundError
from course.grading.gradebook.backup import backups
from course.grading.gradebook.file import (
    SEAL,
    TABLES,
    create,
    explained,
    open_file,
    release,
    row_digest,
    row_into,
    seal,
)
from course.grading.gradebook.pages import Cell, raw_rows
from course.isolation.launch import private_folder, remove_tree

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

__all__ = ["Salvaged", "salvage"]

Row = tuple[Cell, ...]
#: How many of a table's first columns are its key, where it is more than one.
_KEYS = {"times": 4, "found": 2}
#: In place of a submission's digest, where there was none.
_NOTHING = {"", hashlib.sha256().hexdigest()}
_NUMBERED = {"runs", "overrides", "results", "journal"}


@dataclass
class Salvaged:
    """The recovered rows, and the losses.

    Attributes:
        rows: number of rows by table.
        from_backup: of these, those only a backup had.
        lost: known losses, a sentence each.
    """

    rows: Counter[str] = field(default_factory=Counter)
    from_backup: Counter[str] = field(default_factory=Counter)
    lost: list[str] = field(default_factory=list)


def salvage(path: Path, target: Path) -> Salvaged:
    """Write a new gradebook from all intact rows of a damaged one and its backups; those stay unchanged.

    Raises:
        NotFoundError: there is no gradebook and no backup.
        IntegrityError: no row in them is intact.
        UsageError: ``target`` exists.
        MissingCapabilityError: it cannot be written.
    """
    others = backups(path)
    if not path.is_file() and not others:
        raise NotFoundError(
            f"There is no gradebook at {path}, and no backup of one.",
            help="Name the folder that `course grade run --out` wrote.",
            code="gradebook_not_found",
        )
    found: dict[str, dict[Row, Row]] = {name: {} for name in TABLES}
    told = Salvaged()
    if path.is_file():
        _take(_with_log(path), found, Counter())
    _take_decided(found)
    settled = {row[4:6] for row in found["journal"].values() if row[3] == "assign"}
    waiting = dict(found["waiting"]) if path.is_file() else None
    for backup in others:
        _take(backup.read_bytes(), found, told.from_backup)
    _take_decided(found)
    found["found"] = {key: row for key, row in found["found"].items() if row[:2] not in settled}
    if waiting is not None:  # a backup does not know who was graded since
        found["waiting"] = waiting
    if not any(found.values()):
        raise IntegrityError(
            f"{path} has no intact row, and there is no backup.", help="Grade the class into a new folder."
        )
    _write(found, target)
    told.rows = Counter({name: len(rows) for name, rows in found.items()})
    told.lost = list(_lost(found))
    return told


def _with_log(path: Path) -> bytes:
    """The file's bytes, after SQLite, if it still can, merged in what a killed run left beside it."""
    log = path.with_name(path.name + "-wal")
    if not log.exists():
        return path.read_bytes()
    folder = private_folder()
    try:
        copy = folder / path.name
        shutil.copyfile(path, copy)
        shutil.copyfile(log, folder / log.name)
        with contextlib.suppress(sqlite3.Error), contextlib.closing(sqlite3.connect(copy)) as db:
            db.execute("PRAGMA locking_mode = EXCLUSIVE")
            db.execute("PRAGMA journal_mode = DELETE")
        return copy.read_bytes()
    finally:
        remove_tree(folder)


def _take(data: bytes, found: dict[str, dict[Row, Row]], new: Counter[str]) -> None:
    """Add a file's intact rows; known ones stay."""
    for number, values in raw_rows(data):
        table = _table_of(number, values)
        if table is None:
            continue
        row = (number, *values[1:-1]) if table in _NUMBERED else values[:-1]
        key = row[: _KEYS.get(table, 1)]
        if key != (SEAL,) and key not in found[table]:
            found[table][key] = row
            new[table] += 1


def _table_of(number: int | None, values: Row) -> str | None:
    """The table that a row belongs to by its own digest; None if the row is damaged."""
    for name, columns in TABLES.items():
        if len(values) == len(columns) + 1:
            cells = (number, *values[1:-1]) if name in _NUMBERED else values[:-1]
            if row_digest(name, *cells) == values[-1]:
                return name
    return None


def _take_decided(found: dict[str, dict[Row, Row]]) -> None:
    """Overrides that only the journal has."""
    for row in found["journal"].values():
        _, at, _, kind, student, exercise, reason, _, after = row
        if kind in {"override", "lift"}:
            decided = msgspec.json.decode(str(after))
            number = decided["number"]
            score = None if decided["score"] is None else float(decided["score"])
            cells = (student, exercise, score, reason, at)
            if (number,) not in found["overrides"]:
                digest = hashlib.sha256(repr(cells).encode()).hexdigest()
                found["overrides"][number,] = (number, *cells, digest)


def _write(found: dict[str, dict[Row, Row]], target: Path) -> None:
    create(target)
    db = open_file(target, writing=True)
    with contextlib.closing(db), explained(target):
        db.execute("BEGIN IMMEDIATE")
        for name, rows in found.items():
            db.executemany(row_into(name, "INSERT OR IGNORE"), rows.values())
        db.execute("COMMIT")
        seal(db)
        release(db)


def _lost(found: dict[str, dict[Row, Row]]) -> Iterator[str]:
    """Missing rows that others refer to."""
    for name, words in (("results", "results"), ("overrides", "overrides"), ("journal", "notes of changes")):
        numbers = {int(str(key[0])) for key in found[name]}
        gone = sorted(set(range(1, max(numbers, default=0) + 1)) - numbers)
        # Grading the same again gives a result a new number, so a gap need not be a loss.
        if gone and name != "results":
            yield f"{len(gone)} {words}"
    graded = {(row[2], row[3]) for row in found["results"].values()}
    known = {(row[0], row[1]) for row in found["times"].values()} - graded
    yield from (f"the result of {student!s} for {exercise!s}" for student, exercise in sorted(known, key=str))
    files = {key[0] for key in found["submissions"]}
    for row in found["results"].values():
        if row[4] not in files and row[4] not in _NOTHING:
            yield f"what {row[2]!s} handed in for {row[3]!s}"
    packed = {key[0] for key in found["snapshots"]}
    for row in found["runs"].values():
        snapshot = msgspec.json.decode(str(row[3])).get("snapshot")
        if snapshot and snapshot not in packed:
            yield f"the graders of run {row[0]!s}"
