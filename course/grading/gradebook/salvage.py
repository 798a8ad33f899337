"""A new gradebook from a damaged one: every intact row, from the file itself and from its backups.

A row is intact if the digest at its end matches, wherever it was found. So neither the file's header nor its
order matters, and damaged rows are left out. An override is in the gradebook twice, among the overrides and
in the journal, on pages that are not the same.
"""

import contextlib
import hashlib
import itertools
import shutil
import sqlite3
import struct
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

import msgspec

from course.errors import IntegrityError, MissingCapabilityError, NotFoundError
from course.grading.gradebook import file
from course.grading.gradebook.file import KEYS, SEAL, TABLES, override_digest, row_digest
from course.isolation.launch import private_folder, remove_tree

# ---
# The rows on the pages of an SQLite file, read without SQLite, for a file that SQLite refuses.
#
# Nothing in the file is trusted: no header, no pointer, no length. Every page is read by itself, in any
# order; a row that continues on other pages is followed there. The rows are raw, and some are nonsense;
# ``salvage`` keeps those whose own digest matches.
#
# The format: https://www.sqlite.org/fileformat2.html (sections 1.3, 1.6, 1.7 and 2.1).


#: A value as SQLite stores it.
Cell = None | int | float | str | bytes

_MAGIC = b"SQLite format 3\0"
_USUAL_PAGE = 4096
_TABLE_LEAF, _INDEX_LEAF, _INDEX_INTERIOR = 0x0D, 0x0A, 0x02
_MOST_COLUMNS = 32
_INTEGERS = {1: 1, 2: 2, 3: 3, 4: 4, 5: 6, 6: 8}


class _DamagedError(Exception):
    """A row cannot be read."""


def raw_rows(data: bytes) -> Iterator[tuple[int | None, tuple[Cell, ...]]]:
    """Everything that can be read as a row, with its number if it has one.

    Args:
        data: a whole file.
    """
    pages = _Pages(data)
    for number in range(len(data) // pages.size):
        yield from pages.rows(number)


class _Pages:
    """The pages of a file, whose size its header has, and how many bytes in each are unused."""

    def __init__(self, data: bytes) -> None:
        self._data = data
        self.size = self._usable = _USUAL_PAGE  # our own value, where the header is damaged
        if data[:16] == _MAGIC:
            size = struct.unpack(">H", data[16:18])[0]
            size = 65536 if size == 1 else size
            if 512 <= size <= 65536 and size & (size - 1) == 0 and data[20] < 64:
                self.size, self._usable = size, size - data[20]

    def rows(self, number: int) -> Iterator[tuple[int | None, tuple[Cell, ...]]]:
        """The rows that begin on one page."""
        page = self._data[number * self.size : (number + 1) * self.size]
        head = 100 if number == 0 else 0
        kind = page[head]
        if kind not in {_TABLE_LEAF, _INDEX_LEAF, _INDEX_INTERIOR}:
            return
        pointers = head + (12 if kind == _INDEX_INTERIOR else 8)
        count = min(struct.unpack(">H", page[head + 3 : head + 5])[0], (self.size - pointers) // 2)
        for (at,) in struct.iter_unpack(">H", page[pointers : pointers + 2 * count]):
            try:
                yield self._row(page, at, kind)
            except (_DamagedError, IndexError, struct.error, UnicodeDecodeError):
                continue  # of this row nothing is left

    def _row(self, page: bytes, at: int, kind: int) -> tuple[int | None, tuple[Cell, ...]]:
        length, at = _varint(page, at + 4 * (kind == _INDEX_INTERIOR))
        number = None
        if kind == _TABLE_LEAF:
            number, at = _varint(page, at)
        return number, _record(self._payload(page, at, length, kind))

    def _payload(self, page: bytes, at: int, length: int, kind: int) -> bytes:
        """The bytes of a row, those on overflow pages included."""
        usable = self._usable
        if length > len(self._data):
            raise _DamagedError
        most = usable - 35 if kind == _TABLE_LEAF else (usable - 12) * 64 // 255 - 23
        here = length
        if length > most:
            least = (usable - 12) * 32 // 255 - 23
            here = least + (length - least) % (usable - 4)
            here = here if here <= most else least
        found = [page[at : at + here]]
        left = length - here
        following = struct.unpack(">I", page[at + here : at + here + 4])[0] if left else 0
        seen: set[int] = set()
        while left > 0:
            start = (following - 1) * self.size
            if following in seen or following < 2 or start + self.size > len(self._data):
                raise _DamagedError
            seen.add(following)
            following = struct.unpack(">I", self._data[start : start + 4])[0]
            found.append(self._data[start + 4 : start + 4 + min(left, usable - 4)])
            left -= len(found[-1])
        body = b"".join(found)
        if len(body) != length:
            raise _DamagedError
        return body


def _varint(data: bytes, at: int) -> tuple[int, int]:
    """A number of one to nine bytes, and where it ends."""
    value = 0
    for _ in range(8):
        byte = data[at]
        at += 1
        value = value << 7 | byte & 0x7F
        if byte < 0x80:
            return value, at
    return value << 8 | data[at], at + 1


def _record(body: bytes) -> tuple[Cell, ...]:
    end, at = _varint(body, 0)
    if end > len(body):
        raise _DamagedError
    kinds = []
    while at < end:
        kind, at = _varint(body, at)
        kinds.append(kind)
        if len(kinds) > _MOST_COLUMNS:
            raise _DamagedError
    values = []
    for kind in kinds:
        value, at = _value(body, at, kind)
        values.append(value)
    if at != len(body):
        raise _DamagedError
    return tuple(values)


def _value(body: bytes, at: int, kind: int) -> tuple[Cell, int]:
    if kind in {0, 8, 9}:
        return (None, 0, 1)[max(0, kind - 7)], at
    if kind in _INTEGERS:
        end = at + _INTEGERS[kind]
        return int.from_bytes(body[at:end], "big", signed=True), end
    if kind == 7:
        return struct.unpack(">d", body[at : at + 8])[0], at + 8
    if kind < 12:
        raise _DamagedError
    end = at + (kind - 12) // 2
    if end > len(body):
        raise _DamagedError
    return (body[at:end].decode() if kind % 2 else body[at:end]), end


# ---
# Two copies beside a gradebook: of its newest state, and of the one before.


def back_up(path: Path) -> None:
    """Copy a closed gradebook; the previous copy becomes the older one."""
    draft = _named(path, 0)
    try:
        shutil.copyfile(path, draft)
        if _named(path, 1).exists():
            _named(path, 1).replace(_named(path, 2))
        draft.replace(_named(path, 1))
    except OSError as error:
        draft.unlink(missing_ok=True)
        message = f"The backup of {path} cannot be written: {error.strerror}."
        advice = "The gradebook is complete. Make room, and give the command again (a run with --resume)."
        raise MissingCapabilityError(message, help=advice, code="no_backup") from None


def backups(path: Path) -> list[Path]:
    """The existing copies, newest first."""
    return [found for found in (_named(path, 1), _named(path, 2)) if found.is_file()]


def _named(path: Path, number: int) -> Path:
    return path.with_name(f"{path.stem}.backup-{number or 'new'}{path.suffix}")


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
        message = f"There is no gradebook at {path}, and no backup of one."
        advice = "Name the folder that `course grade run --out` wrote."
        raise NotFoundError(message, help=advice, code="gradebook_not_found")
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
        message = f"{path} has no intact row, and there is no backup."
        raise IntegrityError(message, help="Grade the class into a new folder.")
    told.lost = list(_lost(found))
    if told.lost:  # whose results are among it is not known: from now on nothing says who handed in nothing
        found["meta"]["looked",] = ("looked", "{}")
    _write(found, target)
    told.rows = Counter({name: len(rows) for name, rows in found.items()})
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
    for table, row in itertools.starmap(_placed, raw_rows(data)):
        key = row[: _KEYS.get(table, 1)]
        if table and key != (SEAL,) and key not in found[table]:
            found[table][key] = row
            new[table] += 1


def _placed(number: int | None, values: Row) -> tuple[str, Row]:
    """The table that a row belongs to by its own digest, "" if it is damaged, and the row without that."""
    for name, columns in TABLES.items():
        if len(values) == len(columns) + 1:
            cells = (number, *values[1:-1]) if name in _NUMBERED else values[:-1]
            if row_digest(name, *cells) != values[-1]:
                continue
            if name != "overrides":
                return name, cells
            _, student, exercise, score, reason, at, digest = cells  # the one that a gradebook looks for
            told = str(student), str(exercise), score, str(reason), str(at)
            if not isinstance(score, str | bytes) and override_digest(*told) == digest:  # type: ignore[arg-type]
                return name, cells
    return "", ()


class _Decided(msgspec.Struct):
    """What the journal keeps of an override."""

    number: int
    score: float | None


class _Graders(msgspec.Struct):
    """Which graders a run had, of its options."""

    snapshot: str | None = None


def _take_decided(found: dict[str, dict[Row, Row]]) -> None:
    """Overrides that only the journal has."""
    for row in found["journal"].values():
        _, at, _, kind, student, exercise, reason, _, after = row
        if kind in {"override", "lift"}:
            with contextlib.suppress(msgspec.MsgspecError, RecursionError):
                decided = msgspec.json.decode(str(after), type=_Decided)
                cells = (str(student), str(exercise), decided.score, str(reason), str(at))
                if (decided.number,) not in found["overrides"]:
                    found["overrides"][decided.number,] = (decided.number, *cells, override_digest(*cells))


def _write(found: dict[str, dict[Row, Row]], target: Path) -> None:
    file.create(target)
    db = file.open_file(target, writing=True)
    with contextlib.closing(db), file.explained(target):
        db.execute("BEGIN IMMEDIATE")
        for name, rows in found.items():
            db.executemany(file.row_into(name, "INSERT OR IGNORE"), rows.values())
        db.execute("COMMIT")
        file.seal(db)
        file.release(db)


#: What a lost fact about the class is called.
_FACTS = {"late_policy": "the late policy", "looked": "whose work was looked at"}


def _lost(found: dict[str, dict[Row, Row]]) -> Iterator[str]:
    """Missing rows that others refer to."""
    names = str(found["meta"].get((KEYS,), ("", ""))[1]).split()
    yield from (_FACTS.get(name, f"the {name}") for name in names if (name,) not in found["meta"])
    for name, words in (("results", "results"), ("overrides", "overrides"), ("journal", "notes of changes")):
        numbers = {int(str(key[0])) for key in found[name]}
        gone = sorted(set(range(1, max(numbers, default=0) + 1)) - numbers)
        # Grading the same again gives a result a new number, so a gap need not be a loss.
        if gone and name != "results":
            yield f"{len(gone)} {words}"
    graded = {(row[2], row[3]) for row in found["results"].values()}
    # A list of times may name work that was never handed in; every other time came with a submission.
    known = {(row[0], row[1]) for row in found["times"].values() if row[3] != "list"} - graded
    yield from (f"the result of {student!s} for {exercise!s}" for student, exercise in sorted(known, key=str))
    files = {key[0] for key in found["submissions"]}
    for row in found["results"].values():
        if row[4] not in files and row[4] not in _NOTHING:
            yield f"what {row[2]!s} handed in for {row[3]!s}"
    packed = {key[0] for key in found["snapshots"]}
    for row in found["runs"].values():
        with contextlib.suppress(msgspec.MsgspecError, RecursionError):
            snapshot = msgspec.json.decode(str(row[3]), type=_Graders).snapshot
            if snapshot and snapshot not in packed:
                yield f"the graders of run {row[0]!s}"
