"""The record of a student's work, as events that are only ever added.

SQLite with its rollback journal: home folders are often on network file systems, where the write-ahead log
does not work. Each event is one short transaction on a connection of its own, so a ``watch`` and a
``check`` can write at once and a process that dies leaves either the whole event or nothing.
"""

from __future__ import annotations

import contextlib
import errno
import itertools
import json
import math
import os
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any

import msgspec

from course.errors import IntegrityError, MissingCapabilityError
from course.printable import one_line
from course.strangers import no_programs

if TYPE_CHECKING:
    import sqlite3

#: Raised when the tables change; a record written by a newer course is refused, not guessed at.
SCHEMA_VERSION = 1
#: How long a writer waits for another one. In s.
BUSY_TIMEOUT = 10.0

_SCHEMA = (
    """CREATE TABLE event (
        id INTEGER PRIMARY KEY AUTOINCREMENT,
        at TEXT NOT NULL,
        kind TEXT NOT NULL,
        subject TEXT NOT NULL,
        data TEXT NOT NULL
    )""",
    "CREATE INDEX event_by_kind ON event (kind, subject, id)",
    """CREATE TRIGGER event_is_never_changed BEFORE UPDATE ON event
        BEGIN SELECT RAISE(ABORT, 'events are only ever added'); END""",
    """CREATE TRIGGER event_is_never_removed BEFORE DELETE ON event
        BEGIN SELECT RAISE(ABORT, 'events are only ever added'); END""",
)
#: Bytes of one event, and instructions of SQLite for one command: thirty times what a year of work takes.
_LONGEST, _MILLIONS = 10_000_000, 5
#: No space is left, or none of what this user may take.
_FULL = (errno.ENOSPC, errno.EDQUOT)
_INSERT = "INSERT INTO event (at, kind, subject, data) VALUES (?, ?, ?, ?)"
_SELECT = "SELECT id, at, kind, subject, data FROM event"


class _UnreadableError(ValueError):
    """A row is no event."""


@dataclass(frozen=True, slots=True)
class Event:
    """One thing that happened.

    Attributes:
        id: position in the record, 1 first.
        at: when, in UTC.
        kind: "start", "check", "hint", "lesson", "place", "solution", "reset", "update" or "submit"; from the
            reader also "bookmark", "prediction" and "cell".
        subject: the exercise or lesson it is about; empty if none.
        data: facts about it, as plain values.
    """

    id: int
    at: datetime
    kind: str
    subject: str
    data: Mapping[str, Any]


@dataclass(frozen=True, slots=True)
class Record:
    """What was recorded until one moment.

    An event is read when it is asked for: one that somebody spoilt costs only those who need it.

    Attributes:
        path: the file.
        rows: its events, oldest first.
    """

    path: Path
    rows: Sequence[tuple[Any, ...]] = ()

    def events(self, kind: str = "", subject: str = "") -> tuple[Event, ...]:
        """Events of a kind and about a subject, oldest first; an empty string stands for any.

        Raises:
            IntegrityError: one of them cannot be read.
        """
        try:
            return tuple(_event(row) for row in self.rows if kind in ("", row[2]) and subject in ("", row[3]))
        except _UnreadableError as error:
            raise _damaged(self.path, str(error)) from error


@dataclass(frozen=True, slots=True)
class Repair:
    """The repair of a damaged record: where the old one was put, and how many events were recovered."""

    kept: Path
    carried: int


class Store:
    """The record in one file.

    Args:
        path: the file; it and its folder come into being with the first event. The workspace round them has
            to be there: it may have been moved meanwhile, and no second one is made in its old place.
    """

    def __init__(self, path: Path) -> None:
        self.path = path

    def append(self, kind: str, subject: str = "", data: Mapping[str, Any] | None = None) -> None:
        """Add an event.

        Raises:
            IntegrityError: the file is damaged.
            MissingCapabilityError: it cannot be written here, is locked, or is from a newer course.
        """
        # A page or a terminal can send half a surrogate, which no file can hold.
        text = json.dumps(data or {}, ensure_ascii=False).encode("utf-8", "replace").decode()
        self._add([(_now(), kind, subject, text)])

    def events(self, kind: str = "", subject: str = "") -> tuple[Event, ...]:
        """Events of a kind and about a subject, oldest first; an empty string stands for any.

        Raises:
            IntegrityError: the file is damaged.
            MissingCapabilityError: it cannot be read here, is locked, or is from a newer course.
        """
        return self.record(kind, subject).events()

    def record(self, kind: str = "", subject: str = "") -> Record:
        """The same, unread: for who asks for events of several kinds. Raises what ``events`` raises."""
        try:
            if not self.path.exists():
                return Record(self.path)
        except OSError as error:
            raise _not_writable(self.path, error.strerror or str(error)) from error
        query = f"{_SELECT} WHERE (? = '' OR kind = ?) AND (? = '' OR subject = ?) ORDER BY id"
        with self._connection(create=False) as database:
            if _version(database) == 0:
                return Record(self.path)
            return Record(self.path, database.execute(query, (kind, kind, subject, subject)).fetchall())

    def repair(self) -> Repair | None:
        """Set a damaged record aside and carry over what can still be read; None if it is sound.

        The damaged file is renamed, never removed.
        """
        with contextlib.suppress(IntegrityError):
            self.events()
            return None
        names = numbered(self.path.with_name(f"{self.path.stem}.damaged{self.path.suffix}"))
        kept = next(path for path in names if not os.path.lexists(path))
        journal = self.path.with_name(self.path.name + "-journal")
        self.path.rename(kept)
        if journal.exists():
            # It belongs to the damaged file, and SQLite would apply it to the new one.
            journal.rename(kept.with_name(kept.name + "-journal"))
        saved = _salvage(kept)
        self._add(saved)
        return Repair(kept=kept, carried=len(saved))

    def _add(self, rows: Sequence[tuple[str, str, str, str]]) -> None:
        with self._connection(create=True) as database:
            database.execute("BEGIN IMMEDIATE")
            database.executemany(_INSERT, rows)
            database.execute("COMMIT")

    @contextlib.contextmanager
    def _connection(self, *, create: bool) -> Iterator[sqlite3.Connection]:
        """A connection for one transaction, its failures turned into sentences."""
        import sqlite3

        try:
            if create:
                self.path.parent.mkdir(exist_ok=True)
            database = sqlite3.connect(self.path, timeout=BUSY_TIMEOUT, isolation_level=None)
            with contextlib.closing(database):
                database.setlimit(sqlite3.SQLITE_LIMIT_LENGTH, _LONGEST)
                no_programs(database, _SCHEMA, millions=_MILLIONS)
                self._prepare(database, create=create)
                yield database
        except (sqlite3.Error, UnicodeDecodeError) as error:  # the second of names that are no text
            raise self._explained(error) from error
        except FileNotFoundError as error:
            raise gone(self.path.parent.parent) from error
        except OSError as error:
            raise _not_writable(self.path, error.strerror or str(error), full=error.errno in _FULL) from error

    def _prepare(self, database: sqlite3.Connection, *, create: bool) -> None:
        version = _version(database)
        if version > SCHEMA_VERSION:
            problem = f"{self.path} was written by a newer version of the course (format {version})."
            fix = "Install that version or a later one; the file was not touched."
            raise MissingCapabilityError(problem, help=fix, code="progress_too_new")
        if version == 0 and create:
            database.execute("BEGIN IMMEDIATE")
            # Another process may have been first while this one waited for the lock.
            if _version(database) == 0:
                for statement in _SCHEMA:
                    database.execute(statement)
                database.execute(f"PRAGMA user_version = {SCHEMA_VERSION}")
            database.execute("COMMIT")

    def _explained(self, error: Exception) -> Exception:
        name = getattr(error, "sqlite_errorname", "") or ""
        if name.startswith(("SQLITE_BUSY", "SQLITE_LOCKED")):
            problem = f"{self.path} is in use by another program."
            fix = "Wait for it to end, or end it, and run the command again."
            return MissingCapabilityError(problem, help=fix, code="progress_busy")
        refused = ("SQLITE_READONLY", "SQLITE_CANTOPEN", "SQLITE_PERM", "SQLITE_FULL", "SQLITE_IOERR")
        if name.startswith(refused):
            return _not_writable(self.path, str(error), full=name == "SQLITE_FULL")
        return _damaged(self.path, one_line(str(error))[:200])


def _version(database: sqlite3.Connection) -> int:
    return int(database.execute("PRAGMA user_version").fetchone()[0])


def _now() -> str:
    return datetime.now(UTC).isoformat(timespec="milliseconds")


class _Known(msgspec.Struct):
    """Facts that are counted with, whatever the kind of the event, and what each of them is."""

    checks: list[Any] = []
    questions: list[Any] = []
    right: bool | dict[str, Any] = False
    index: int = 0
    seed: int = 0
    score: float | None = None


def _event(row: tuple[Any, ...]) -> Event:
    number, at, kind, subject, data = row
    try:
        when = datetime.fromisoformat(at)
        values = json.loads(data)
        known = msgspec.convert(values, _Known)
    except (TypeError, ValueError, RecursionError, msgspec.ValidationError) as error:
        raise _UnreadableError(f"event {number} cannot be read") from error
    # Beyond these years no clock of a time zone is.
    if when.tzinfo is None or not 1970 <= when.year < 9000 or not math.isfinite(known.score or 0.0):
        raise _UnreadableError(f"event {number} cannot be read")
    return Event(id=number, at=when, kind=str(kind), subject=str(subject), data=values)


def _salvage(damaged: Path) -> list[tuple[str, str, str, str]]:
    """The events that can still be read out of a damaged file, each checked on its own."""
    import sqlite3

    rows: list[tuple[str, str, str, str]] = []
    with (
        contextlib.suppress(sqlite3.Error, UnicodeDecodeError),
        contextlib.closing(sqlite3.connect(damaged)) as database,
    ):
        database.setlimit(sqlite3.SQLITE_LIMIT_LENGTH, _LONGEST)
        no_programs(database, _SCHEMA, millions=_MILLIONS)
        cursor = database.execute(f"{_SELECT} ORDER BY id")
        while (row := cursor.fetchone()) is not None:
            with contextlib.suppress(_UnreadableError):
                _event(row)
                rows.append(row[1:])
    return rows


def numbered(path: Path) -> Iterator[Path]:
    """``path`` itself, then run-2.csv, run-3.csv and so on, to find one that does not exist."""
    yield path
    yield from (path.with_name(f"{path.stem}-{number}{path.suffix}") for number in itertools.count(2))


def _damaged(path: Path, reason: str) -> IntegrityError:
    return IntegrityError(
        f"The record of your progress, {path}, is damaged ({reason}).",
        help="Run `course doctor --repair`: it keeps the damaged file under another name, carries over what "
        "can still be read and starts a new record. Your exercises are not touched.",
        code="progress_damaged",
    )


def gone(root: Path) -> MissingCapabilityError:
    """The error that a workspace is no longer where it was."""
    problem = f"The workspace {root} is no longer there: it was moved or removed."
    fix = "Leave this, change to where the workspace is now, and start again there."
    return MissingCapabilityError(problem, help=fix, code="workspace_gone")


def _not_writable(path: Path, reason: str, *, full: bool = False) -> MissingCapabilityError:
    problem = f"{path} cannot be used ({reason})."
    fix = "Make the workspace writable, or copy it to a folder that is."
    if full:
        fix = "Free some space on its disk, or copy the workspace to another one."
    return MissingCapabilityError(problem, help=fix, code="not_writable")
