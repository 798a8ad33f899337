"""``gradebook.sqlite``: the one truth of a grading run. Every other file there is an export of it.

One coordinator writes it. Results go in by transactions of a fraction of a second, so that a run that is
killed loses no more than that and leaves a file that opens. A result is kept under student, exercise,
submission, grader and seed: grading the same again changes nothing, grading anew keeps the old beside it.
"""

from __future__ import annotations

import contextlib
import hashlib
import sqlite3
import time
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Self

import msgspec

from course.errors import IntegrityError, NotFoundError, UsageError
from course.grading.verdict import Verdict, finite

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

__all__ = ["FORMAT_VERSION", "Gradebook", "Key", "Result"]

FORMAT_VERSION = 1
_APPLICATION_ID = 0x636F7273  # "cors": tells this file from any other SQLite database
_COMMIT_EVERY_S = 0.5
_COMMIT_EVERY = 64

_SCHEMA = """
CREATE TABLE meta (key TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID;
CREATE TABLE results (
    number INTEGER PRIMARY KEY,
    student TEXT NOT NULL,
    exercise TEXT NOT NULL,
    submission_sha256 TEXT NOT NULL,
    grader_version TEXT NOT NULL,
    seed INTEGER NOT NULL,
    late REAL,
    graded_at TEXT NOT NULL,
    verdict BLOB NOT NULL,
    verdict_sha256 TEXT NOT NULL,
    UNIQUE (student, exercise, submission_sha256, grader_version, seed)
);
"""


@dataclass(frozen=True, order=True)
class Key:
    """What one result is about."""

    student: str
    exercise: str
    submission_sha256: str
    grader_version: str
    seed: int


@dataclass(frozen=True)
class Result:
    """One result as it is kept.

    Attributes:
        late: seconds after the deadline, None if not late or not known.
        graded_at: UTC, ISO 8601.
    """

    key: Key
    verdict: Verdict
    late: float | None = None
    graded_at: str = ""


class Gradebook:
    """An open gradebook.

    Args:
        path: the file.
        create: make a new one; otherwise it must exist.
        writing: hold it against a second writer.

    Raises:
        NotFoundError: there is none.
        UsageError: it belongs to a newer version, or another run is writing it.
        IntegrityError: the file is damaged or no gradebook.
    """

    def __init__(self, path: Path, *, create: bool = False, writing: bool = False) -> None:
        if not create and not path.is_file():
            raise NotFoundError(
                f"There is no gradebook at {path}.",
                help="Name the folder that `course grade run --out` wrote.",
                code="gradebook_not_found",
            )
        self.path = path
        self._pending = 0
        self._committed_at = time.monotonic()
        if create:
            with self._explained():
                _create(path)
        self._db = sqlite3.connect(path, isolation_level=None, timeout=1.0)
        with self._explained():
            if create or writing:
                # One writer: a second run on the same folder is told so instead of mixing its results in.
                # The lock is the operating system's, so it ends with the process however that ends.
                self._db.execute("PRAGMA locking_mode = EXCLUSIVE")
            self._db.execute("PRAGMA journal_mode = DELETE")  # OUT may be on a network: WAL fails there
            self._check_format()
            if writing:
                self._db.execute("BEGIN IMMEDIATE")
                self._db.execute("COMMIT")

    def _check_format(self) -> None:
        if self._one("PRAGMA application_id") != _APPLICATION_ID:
            raise IntegrityError(f"{self.path} is not a gradebook.", help="Name another folder.")
        version = self._one("PRAGMA user_version")
        if version > FORMAT_VERSION:
            raise UsageError(
                f"{self.path} was written by a newer version of this course (format {version}).",
                help="Update the course; nothing was changed.",
                code="newer_format",
            )

    @contextlib.contextmanager
    def _explained(self) -> Iterator[None]:
        """SQLite's errors as sentences."""
        try:
            yield
        except sqlite3.OperationalError as error:
            if "locked" in str(error):
                raise UsageError(
                    f"Another run is writing {self.path}.",
                    help="Wait for it to end, or name another --out.",
                    code="gradebook_locked",
                ) from None
            raise UsageError(
                f"{self.path} cannot be used: {error}.",
                help="Is the disk full or the folder read-only? What was graded so far is kept.",
                code="gradebook_unusable",
            ) from None
        except sqlite3.DatabaseError as error:
            raise IntegrityError(
                f"{self.path} is damaged: {error}.",
                help="Restore it from a backup, or grade into a new folder; this file was not changed.",
            ) from None

    def _one(self, query: str) -> Any:
        return self._db.execute(query).fetchone()[0]

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Write what is pending and close the file."""
        try:
            self.flush()
        finally:
            self._db.close()

    # -- facts about the run --------------------------------------------------------------------------

    def meta(self) -> dict[str, str]:
        """Facts about the run: course version, seed, protection, ..."""
        with self._explained():
            return dict(self._db.execute("SELECT key, value FROM meta ORDER BY key"))

    def set_meta(self, **facts: str) -> None:
        """Record facts about the run."""
        self.flush()
        with self._explained():
            self._db.execute("BEGIN IMMEDIATE")
            self._db.executemany("INSERT OR REPLACE INTO meta VALUES (?, ?)", facts.items())
            self._db.execute("COMMIT")

    # -- results --------------------------------------------------------------------------------------

    def add(self, result: Result) -> None:
        """Keep a result; it is on disk within half a second or at ``flush``."""
        body = msgspec.json.encode(finite(msgspec.to_builtins(result.verdict)))
        row = (*vars(result.key).values(), result.late, result.graded_at or _now(), body, _sha256(body))
        with self._explained():
            if not self._pending:
                self._db.execute("BEGIN IMMEDIATE")
            self._db.execute(
                "INSERT OR REPLACE INTO results (student, exercise, submission_sha256, grader_version, seed,"
                " late, graded_at, verdict, verdict_sha256) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?)",
                row,
            )
        self._pending += 1
        if self._pending >= _COMMIT_EVERY or time.monotonic() - self._committed_at > _COMMIT_EVERY_S:
            self.flush()

    def flush(self) -> None:
        """Put everything on disk."""
        if self._pending:
            with self._explained():
                self._db.execute("COMMIT")
            self._pending = 0
        self._committed_at = time.monotonic()

    def has(self, key: Key) -> bool:
        """Whether this very submission was graded by this very grader, other than by a fault of ours."""
        with self._explained():
            row = self._db.execute(
                "SELECT verdict FROM results WHERE student = ? AND exercise = ? AND submission_sha256 = ?"
                " AND grader_version = ? AND seed = ?",
                tuple(vars(key).values()),
            ).fetchone()
        return row is not None and msgspec.json.decode(row[0], type=Verdict).state != "grader_error"

    def results(self, student: str | None = None, exercise: str | None = None) -> Iterator[Result]:
        """The newest result of each student and exercise, ordered by both.

        Raises:
            IntegrityError: a result is not what was written.
        """
        query = (
            "SELECT student, exercise, submission_sha256, grader_version, seed, late, graded_at, verdict,"
            " verdict_sha256, max(number) FROM results WHERE (?1 IS NULL OR student = ?1)"
            " AND (?2 IS NULL OR exercise = ?2) GROUP BY student, exercise ORDER BY student, exercise"
        )
        with self._explained():
            for row in self._db.execute(query, (student, exercise)):
                *key, late, graded_at, body, digest, _ = row
                if _sha256(body) != digest:
                    raise IntegrityError(
                        f"The result of {key[0]!r} for {key[1]} in {self.path} fails its checksum.",
                        help="Restore the gradebook from a backup, or grade into a new folder.",
                    )
                yield Result(Key(*key), msgspec.json.decode(body, type=Verdict), late, graded_at)


def _create(path: Path) -> None:
    """An empty gradebook, made under another name first: a run killed here leaves none instead of half."""
    draft = path.with_suffix(".new")
    draft.unlink(missing_ok=True)
    with contextlib.closing(sqlite3.connect(draft)) as db:
        db.executescript(
            f"BEGIN EXCLUSIVE; {_SCHEMA} PRAGMA user_version = {FORMAT_VERSION};"
            f"PRAGMA application_id = {_APPLICATION_ID}; COMMIT;"
        )
    draft.replace(path)


def _sha256(body: bytes | str) -> str:
    # Whoever edits the file by hand may leave text where bytes were: that is damage too, not a crash.
    return hashlib.sha256(body.encode() if isinstance(body, str) else body).hexdigest()


def _now() -> str:
    return time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime())
