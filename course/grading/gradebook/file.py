"""The file below a gradebook: its format, its lock, and its errors as sentences.

A run writes in SQLite's write-ahead mode while it has the file to itself. Every result is committed when it
arrives (about 0.05 ms): a process that is killed loses nothing that was reported, and a machine that loses
power leaves a consistent file that lacks the last seconds. Held exclusively, that mode needs no shared memory
and so works on network folders; closing puts the file back into the ordinary mode, in which it is one file
that can be copied.

Closing also seals it: a digest over every row is stored in it and compared on opening. The first write breaks
the seal, so a file whose writer was killed has none, and is accepted without.

Every row ends with a digest of itself and its table's name. So ``salvage`` recognises the intact rows of a
damaged file without anything around them. Deleted rows are overwritten, so none that was removed on purpose
comes back.
"""

import contextlib
import hashlib
import itertools
import os
import re
import sqlite3
from collections.abc import Iterator
from pathlib import Path

import msgspec

from course.errors import CourseError, IntegrityError, MissingCapabilityError, NotFoundError, UsageError
from course.printable import command, one_line
from course.strangers import no_programs

#: 2 had no seal; 3 had no digests of rows, no snapshots, no journal, and did not know who waits. These can be
#: read; 4 was never released.
FORMAT_VERSION = 5
#: The name of the seal among the facts about a run.
SEAL = "seal"
#: The name of the list of these facts, by which ``salvage`` knows what is lost.
KEYS = "keys"
#: Instructions of SQLite until it is open; a class of a thousand takes three.
_MILLIONS = 200
_MOST_SAID = 200
_APPLICATION_ID = 0x636F7273  # "cors": tells this file from any other SQLite database

#: The tables of formats 1 to 3. Since then each has a last column: the digest of its row.
_TABLES = """
CREATE TABLE meta (key TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID;
CREATE TABLE runs (
    number INTEGER PRIMARY KEY, kind TEXT NOT NULL, started_at TEXT NOT NULL, options TEXT NOT NULL
);
CREATE TABLE exercises (
    id TEXT PRIMARY KEY, title TEXT NOT NULL, max_points REAL NOT NULL, pass_share REAL NOT NULL,
    position INTEGER NOT NULL
) WITHOUT ROWID;
CREATE TABLE students (student TEXT PRIMARY KEY, identity TEXT NOT NULL) WITHOUT ROWID;
CREATE TABLE submissions (sha256 TEXT PRIMARY KEY, files BLOB NOT NULL) WITHOUT ROWID;
CREATE TABLE times (
    student TEXT NOT NULL, exercise TEXT NOT NULL, submission_sha256 TEXT NOT NULL, source TEXT NOT NULL,
    at REAL, PRIMARY KEY (student, exercise, submission_sha256, source)
) WITHOUT ROWID;
CREATE TABLE overrides (
    number INTEGER PRIMARY KEY, student TEXT NOT NULL, exercise TEXT NOT NULL, score REAL,
    reason TEXT NOT NULL, at TEXT NOT NULL, sha256 TEXT NOT NULL
);
"""
_RESULTS = """
CREATE TABLE results (
    number INTEGER PRIMARY KEY,
    run INTEGER NOT NULL,
    student TEXT NOT NULL,
    exercise TEXT NOT NULL,
    submission_sha256 TEXT NOT NULL,
    grader_version TEXT NOT NULL,
    seed INTEGER NOT NULL,
    graded_at TEXT NOT NULL,
    verdict BLOB NOT NULL,
    verdict_sha256 TEXT NOT NULL,
    UNIQUE (student, exercise, submission_sha256, grader_version, seed, run)
);
"""
#: After format 3: the graders of each run as one zip; files that are not a submission yet; who changed
#: a grade, when, why, and what it was before; and students whose work a run has still to look at.
_SINCE_3 = """
CREATE TABLE snapshots (
    sha256 TEXT PRIMARY KEY, packed BLOB NOT NULL, row_sha256 TEXT
) WITHOUT ROWID;
CREATE TABLE found (
    student TEXT NOT NULL, exercise TEXT NOT NULL, listed TEXT NOT NULL, row_sha256 TEXT,
    PRIMARY KEY (student, exercise)
) WITHOUT ROWID;
CREATE TABLE journal (
    number INTEGER PRIMARY KEY, at TEXT NOT NULL, who TEXT NOT NULL, kind TEXT NOT NULL,
    student TEXT NOT NULL, exercise TEXT NOT NULL, reason TEXT NOT NULL, before TEXT NOT NULL,
    after TEXT NOT NULL, row_sha256 TEXT
);
CREATE TABLE waiting (student TEXT PRIMARY KEY, row_sha256 TEXT) WITHOUT ROWID;
"""


def _columns(statements: str) -> dict[str, tuple[str, ...]]:
    """The columns of the tables that are made so, but for the last of each: the digest of the others."""
    made = re.findall(r"CREATE TABLE (\w+) \((.+?)\)(?: WITHOUT ROWID)?;", statements, re.DOTALL)
    column = re.compile(r"\b(?!row_sha256)(\w+) (?:TEXT|INTEGER|REAL|BLOB)\b")
    return {name: tuple(column.findall(body)) for name, body in made}


_OLD = _columns(_TABLES + _RESULTS)
TABLES = _OLD | _columns(_SINCE_3)
_DIGESTS = "".join(
    f"ALTER TABLE {name} ADD COLUMN row_sha256 TEXT;"
    f"UPDATE {name} SET row_sha256 = row_digest('{name}', {', '.join(TABLES[name])});"
    for name in _OLD
)
_SEALED = (
    f"SELECT * FROM meta WHERE key != '{SEAL}' ORDER BY key",
    "SELECT * FROM runs ORDER BY number",
    "SELECT * FROM exercises ORDER BY id",
    "SELECT * FROM students ORDER BY student",
    "SELECT sha256 FROM submissions ORDER BY sha256",
    "SELECT * FROM times ORDER BY student, exercise, submission_sha256, source",
    "SELECT * FROM overrides ORDER BY number",
    "SELECT number, run, student, exercise, submission_sha256, grader_version, seed, graded_at,"
    " verdict_sha256 FROM results ORDER BY number",
)
_SEALED_NOW = (
    *_SEALED,
    "SELECT sha256 FROM snapshots ORDER BY sha256",
    "SELECT * FROM found ORDER BY student, exercise",
    "SELECT * FROM journal ORDER BY number",
    "SELECT * FROM waiting ORDER BY student",
)
#: Format 1 had results alone, and in them a lateness that was never filled in.
_FROM_1 = f"""
ALTER TABLE results RENAME TO results_1;
{_TABLES.replace("CREATE TABLE meta (key TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID;", "")}
{_RESULTS}
INSERT INTO runs VALUES (1, 'run', '', '{{}}');
INSERT INTO results SELECT number, 1, student, exercise, submission_sha256, grader_version, seed, graded_at,
    verdict, verdict_sha256 FROM results_1;
DROP TABLE results_1;
"""


def row_digest(table: str, *cells: object) -> str:
    """The last cell of a row: a digest of the table's name and the cells before it."""
    digest = hashlib.sha256(table.encode())
    for cell in cells:
        if isinstance(cell, bytes):
            kind, body = b"b", cell
        elif isinstance(cell, str):
            kind, body = b"s", cell.encode("utf-8", "surrogatepass")
        else:
            # SQLite keeps 10.0 as 10 in the file and gives 10.0 back.
            whole = isinstance(cell, float) and cell.is_integer()
            kind, body = b"n", repr(int(cell) if whole else cell).encode()  # type: ignore[call-overload]
        digest.update(kind + str(len(body)).encode() + b":" + body)
    return digest.hexdigest()[:32]


def override_digest(student: str, exercise: str, score: float | None, reason: str, at: str) -> str:
    """An override's own digest. SQLite keeps no sign of a zero, and gives 10 back as 10.0."""
    number = None if score is None else float(score) + 0.0
    row = repr((student, exercise, number, reason, at)).encode()
    return hashlib.sha256(row).hexdigest()


def row_into(table: str, how: str = "INSERT") -> str:
    """A statement that puts one row into a table, its digest included."""
    cells = ", ".join(f"?{number}" for number in range(1, len(TABLES[table]) + 1))
    return f"{how} INTO {table} VALUES ({cells}, row_digest('{table}', {cells}))"


def rescue(path: Path, otherwise: str = "") -> str:
    """How to go on with what is left of a gradebook; ``otherwise``, if there is none and has no backup."""
    out = path.parent
    if otherwise and not any(out.glob(f"{path.stem}.backup-[1-9]{path.suffix}")):
        return otherwise
    salvage = command("grade", "salvage", out, "--to", f"{out}-salvaged")
    return (
        f"{salvage} writes the intact rows of it and its backups to a new folder; this file was not changed."
    )


@contextlib.contextmanager
def explained(path: Path) -> Iterator[None]:
    """Errors of SQLite, and of what reads the content of a row, as sentences.

    Raises:
        UsageError: another process is using the file.
        MissingCapabilityError: it cannot be read or written where it is.
        IntegrityError: it is damaged.
    """
    try:
        yield
    except sqlite3.OperationalError as error:
        raise _operational(path, error) from None
    except (sqlite3.DatabaseError, msgspec.MsgspecError, RecursionError, UnicodeDecodeError) as error:
        message = f"{path} is damaged: {one_line(str(error))[:_MOST_SAID]}."
        raise IntegrityError(message, help=rescue(path)) from None


def _operational(path: Path, error: sqlite3.OperationalError) -> CourseError:
    # The low byte is the kind of fault, the rest a detail of it. Python's own errors, such as text that is
    # not UTF-8, carry no code: the file is not as it was written.
    kind = getattr(error, "sqlite_errorcode", sqlite3.SQLITE_CORRUPT) & 0xFF
    if kind in {sqlite3.SQLITE_BUSY, sqlite3.SQLITE_LOCKED}:
        return UsageError(
            f"Another run is writing {path}.", help="Wait for it to end.", code="gradebook_locked"
        )
    # SQLITE_ERROR: a table or a column that our statements name is not there.
    if kind in {sqlite3.SQLITE_ERROR, sqlite3.SQLITE_CORRUPT, sqlite3.SQLITE_NOTADB}:
        return IntegrityError(f"{path} is damaged: {error}.", help=rescue(path))
    if kind == sqlite3.SQLITE_FULL:
        message, code = f"The disk is full: {path} cannot grow.", "disk_full"
        fix = "Make room, then give the command again (a run with --resume)."
    elif kind in {sqlite3.SQLITE_READONLY, sqlite3.SQLITE_CANTOPEN, sqlite3.SQLITE_PERM}:
        message, code = f"{path} cannot be written.", "read_only"
        fix = "Make the folder writable, or copy it somewhere that is."
    else:
        message, fix, code = f"{path} cannot be used: {error}.", "Check the disk.", "gradebook_unusable"
    return MissingCapabilityError(message, help=f"{fix} All results so far are kept.", code=code)


def create(path: Path) -> None:
    """An empty gradebook, made under another name first: a run killed here leaves none, not half of one.

    Raises:
        UsageError: another run made one meanwhile.
    """
    # A name that no other process uses; a killed run's name is reused only if its process is gone.
    names = (f"{path.stem}.new-{os.getpid()}-{number}" for number in itertools.count())
    draft = next(draft for draft in map(path.with_name, names) if not draft.exists())
    try:
        with explained(path), contextlib.closing(sqlite3.connect(draft)) as db:
            _know_digests(db)
            db.executescript(
                f"BEGIN EXCLUSIVE; {_TABLES} {_RESULTS} {_DIGESTS} {_SINCE_3}"
                f"PRAGMA user_version = {FORMAT_VERSION}; PRAGMA application_id = {_APPLICATION_ID}; COMMIT;"
            )
        _publish(draft, path)
    finally:
        draft.unlink(missing_ok=True)


def _publish(draft: Path, path: Path) -> None:
    """Give the draft its name, unless there is such a file: of two simultaneous runs, one gets an error."""
    try:
        path.hardlink_to(draft)
    except (FileExistsError, FileNotFoundError):
        message = f"Another run is writing {path}."
        raise UsageError(message, help="Name another --out.", code="gradebook_locked") from None
    except OSError:  # a file system without hard links
        if path.exists():
            message = f"{path} exists already; nothing was touched."
            raise UsageError(message, help="Name a new folder.", code="out_exists") from None
        draft.replace(path)


def open_file(path: Path, *, writing: bool) -> sqlite3.Connection:
    """An open, recognised and up-to-date gradebook.

    Args:
        writing: lock it against all other processes until it is closed.

    Raises:
        NotFoundError: there is none.
        UsageError: another process is writing it.
        MissingCapabilityError: it belongs to a newer version, or cannot be written here.
        IntegrityError: the file is damaged or no gradebook.
    """
    if not path.is_file():
        message = f"There is no gradebook at {path}."
        advice = rescue(path, "Name the folder that `course grade run --out` wrote.")
        raise NotFoundError(message, help=advice, code="gradebook_not_found")
    with explained(path):
        db = sqlite3.connect(path, isolation_level=None, timeout=1.0)
    try:
        with explained(path):
            _prepare(db, path, writing=writing)
    except BaseException:
        db.close()
        raise
    return db


def _prepare(db: sqlite3.Connection, path: Path, *, writing: bool) -> None:
    log = path.with_name(path.name + "-wal")
    if writing or log.exists():
        # Before the first look at a file in write-ahead mode: held alone it needs no shared memory.
        db.execute("PRAGMA locking_mode = EXCLUSIVE")
    _know_digests(db)
    version = _checked_format(db, path)
    no_programs(db, millions=_MILLIONS)
    if version == 1:
        _keep(db, path, version)
        db.executescript(f"BEGIN EXCLUSIVE; {_FROM_1} PRAGMA user_version = 3; COMMIT;")
    if writing:
        # The lock is the operating system's, so it ends with the process however that ends.
        db.execute("BEGIN EXCLUSIVE")
        db.execute("COMMIT")
    elif log.exists():
        release(db)  # a run was killed: what it left beside the file goes into it
        db.execute("PRAGMA locking_mode = NORMAL")
        db.execute("SELECT count(*) FROM meta").fetchone()
    kept = db.execute("SELECT value FROM meta WHERE key = ?", (SEAL,)).fetchone()
    if kept is not None and kept[0] != _digest(db, _SEALED if version < FORMAT_VERSION else _SEALED_NOW):
        message = f"{path} is damaged: its content is not what the course wrote."
        raise IntegrityError(message, help=rescue(path))
    if version < FORMAT_VERSION and writing:
        _keep(db, path, version)
        db.executescript(
            f"BEGIN EXCLUSIVE; {_DIGESTS} {_SINCE_3} PRAGMA user_version = {FORMAT_VERSION}; COMMIT;"
        )
        if kept is not None:
            seal(db)
    elif version < FORMAT_VERSION:  # unchanged; missing tables count as empty
        db.executescript(_SINCE_3.replace("CREATE TABLE", "CREATE TEMP TABLE"))
    db.set_progress_handler(None, 0)  # what is in it has an end: it was all read for its digest


def _keep(db: sqlite3.Connection, path: Path, version: int) -> None:
    """A copy in the old format, which the version that wrote it reads."""
    copy = path.with_name(f"{path.stem}.format-{version}{path.suffix}")
    if not copy.exists():
        with contextlib.closing(sqlite3.connect(copy)) as kept:
            db.backup(kept)


def _know_digests(db: sqlite3.Connection) -> None:
    db.create_function("row_digest", -1, row_digest, deterministic=True)
    db.execute("PRAGMA secure_delete = ON")


def seal(db: sqlite3.Connection) -> None:
    """Note what is in it now."""
    sealed = _digest(db, _SEALED_NOW)
    db.execute(row_into("meta", "INSERT OR REPLACE"), (SEAL, sealed))


def unseal(db: sqlite3.Connection) -> None:
    """Within a transaction that is about to change it."""
    db.execute("DELETE FROM meta WHERE key = ?", (SEAL,))


def _digest(db: sqlite3.Connection, queries: tuple[str, ...]) -> str:
    """The digest over all rows; large contents count by their own digests, which are in the rows."""
    digest = hashlib.sha256()
    for query in queries:
        digest.update(f"{query}\n".encode())
        for row in db.execute(query):
            digest.update(f"{row!r}\n".encode("utf-8", "surrogatepass"))
    return digest.hexdigest()


def begin_writing(db: sqlite3.Connection) -> None:
    """Commit at once and cheaply from here on; to be undone by ``release``."""
    db.execute("PRAGMA journal_mode = WAL")
    db.execute("PRAGMA synchronous = NORMAL")


def release(db: sqlite3.Connection) -> None:
    """Put everything into the one file."""
    db.execute("PRAGMA journal_mode = DELETE")


def _checked_format(db: sqlite3.Connection, path: Path) -> int:
    if db.execute("PRAGMA application_id").fetchone()[0] != _APPLICATION_ID:
        raise IntegrityError(f"{path} is not a gradebook.", help=rescue(path, "Name another folder."))
    version = int(db.execute("PRAGMA user_version").fetchone()[0])
    if version > FORMAT_VERSION:
        message = f"{path} was written by a newer version of this course (format {version})."
        advice = "Update the course; nothing was changed."
        raise MissingCapabilityError(message, help=advice, code="newer_format")
    return version
