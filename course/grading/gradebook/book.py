"""``gradebook.sqlite``: the record of a grading run. Every other file beside it is an export.

One coordinator writes it. A result is kept under student, exercise, submission, grader, seed and run: grading
the same again changes nothing, and a new grading keeps the old results as well. The submissions themselves
are in it too, so that a regrading needs only this file. Later decisions of the instructor (a score in place
of the graders', a late policy) are stored separately and never change the results;
``course.grading.results.effective`` puts the two together.
"""

import contextlib
import getpass
import hashlib
import os
import sqlite3
import time
import zlib
from collections.abc import Iterable, Iterator, Mapping
from contextlib import AbstractContextManager
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any, Self, TypeVar

import msgspec

from course.errors import CourseError, IntegrityError
from course.grading.gradebook import file
from course.grading.gradebook.file import KEYS, SEAL, TABLES, explained, override_digest, rescue, row_into
from course.grading.gradebook.records import (
    Decision,
    GradedExercise,
    Key,
    Looked,
    Override,
    PlatformIdentity,
    Result,
    Run,
    SubmittedAt,
)
from course.scoring.verdict import Verdict, finite

#: Bytes of all files of one submission, unpacked.
_MOST_UNPACKED = 64 << 20
#: Before what is masked, where version 1.2.0 has the first byte of zlib's own.
_MASK, _SALT = b"m", 16


def _masked(packed: bytes, salt: bytes) -> bytes:
    """Bytes that nobody could foresee, and the same packed files again from them.

    zlib stores what it cannot shorten as it is. A file handed in could then hold pages of a gradebook, with
    rows of its own, and ``salvage`` would find them in a damaged one.
    """
    stream = hashlib.shake_256(salt).digest(len(packed))
    mixed = int.from_bytes(packed) ^ int.from_bytes(stream)
    return _MASK + salt + mixed.to_bytes(len(packed))


T = TypeVar("T")
_CHECKPOINT_S = 5.0  # the most that a power cut costs


class Gradebook:
    """An open gradebook. What reads rows raises IntegrityError where one is not what was written.

    Args:
        create: make a new one; otherwise it must exist.
        writing: lock it against all other processes.

    Attributes:
        write_s: seconds spent on writing.

    Raises:
        NotFoundError: there is none.
        UsageError: another run is writing it.
        MissingCapabilityError: it belongs to a newer version, or cannot be written.
        IntegrityError: the file is damaged or no gradebook.
    """

    def __init__(self, path: Path, *, create: bool = False, writing: bool = False) -> None:
        self.path = path
        self.write_s = 0.0
        self._writing = create or writing
        self._begun = False
        self._changed = False
        self._checkpoint_at = time.monotonic() + _CHECKPOINT_S
        if create:
            file.create(path)
        self._db = file.open_file(path, writing=self._writing)
        ((self._run,),) = self._rows("SELECT ifnull(max(number), 0) FROM runs")

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: object, *_: object) -> None:
        if kind is None:
            self.close()
            return
        with contextlib.suppress(CourseError):  # the first error is the one to report
            self.close()

    def close(self) -> None:
        """Put everything into the one file and close it."""
        try:
            with explained(self.path):
                if self._changed:
                    file.seal(self._db)
                if self._begun:
                    file.release(self._db)
        finally:
            self._db.close()

    # -- facts about the run --------------------------------------------------------------------------

    def meta(self) -> dict[str, str]:
        """Facts about the run: course, version, seed, late policy, roster, ..."""
        query = "SELECT key, value FROM meta WHERE key NOT IN (?, ?) ORDER BY key"
        return dict(self._rows(query, SEAL, KEYS))

    def set_meta(self, **facts: str | None) -> None:
        """Record facts about the run; None removes one."""
        with self._transaction():
            for name, value in facts.items():
                if value is None:
                    self._db.execute("DELETE FROM meta WHERE key = ?", (name,))
                else:
                    self._db.execute(row_into("meta", "INSERT OR REPLACE"), (name, value))
            names = " ".join(name for (name,) in self._db.execute("SELECT key FROM meta") if name != KEYS)
            self._db.execute(row_into("meta", "INSERT OR REPLACE"), (KEYS, names))

    def begin_run(self, kind: str, options: Mapping[str, Any]) -> None:
        """Note that a grading ("run") or regrading ("rerun") begins; its results are kept apart."""
        with self._transaction():
            self._run += 1
            text = msgspec.json.encode({**options, "who": whoami()}).decode()
            self._db.execute(row_into("runs"), (self._run, kind, _now(), text))

    def runs(self) -> list[Run]:
        """Every grading and regrading, oldest first."""
        with explained(self.path):
            rows = self._db.execute("SELECT number, kind, started_at, options FROM runs ORDER BY number")
            return [_as(Run, (number, kind, at, _options(options))) for number, kind, at, options in rows]

    def run_options(self) -> dict[str, Any]:
        """The options of the latest run; empty if none was noted."""
        with explained(self.path):
            row = self._db.execute("SELECT options FROM runs ORDER BY number DESC LIMIT 1").fetchone()
            return _options(row[0]) if row else {}

    def set_exercises(self, exercises: Iterable[GradedExercise]) -> None:
        """Note the exercises that are graded; earlier ones stay."""
        rows = [msgspec.structs.astuple(exercise) for exercise in exercises]
        with self._transaction():
            self._db.executemany(row_into("exercises", "INSERT OR REPLACE"), rows)

    def exercises(self) -> tuple[GradedExercise, ...]:
        """The graded exercises, in the order of the course."""
        query = "SELECT id, title, max_points, pass_share, position FROM exercises ORDER BY position, id"
        with explained(self.path):
            return tuple(_as(GradedExercise, row) for row in self._db.execute(query))

    # -- students -------------------------------------------------------------------------------------

    def set_students(self, students: Mapping[str, PlatformIdentity]) -> None:
        """Note the students' identities in the system they were downloaded from."""
        rows = [(name, msgspec.json.encode(who).decode()) for name, who in students.items()]
        with self._transaction():
            self._db.executemany(row_into("students", "INSERT OR REPLACE"), rows)

    def students(self) -> dict[str, PlatformIdentity]:
        """The students' identities in the system they were downloaded from; empty for plain folders."""
        with explained(self.path):
            rows = self._db.execute("SELECT student, identity FROM students").fetchall()
            return {student: msgspec.json.decode(text, type=PlatformIdentity) for student, text in rows}

    def add_times(self, times: Iterable[SubmittedAt], *, replace: bool = False) -> None:
        """Note when things were handed in. Of one witness's times for one content the earliest stays."""
        earliest = "excluded.at" if replace else "min(ifnull(at, excluded.at), ifnull(excluded.at, at))"
        digest = f"row_digest('times', student, exercise, submission_sha256, source, {earliest})"
        with self._transaction():
            self._db.executemany(
                f"{row_into('times')} ON CONFLICT DO UPDATE SET at = {earliest}, row_sha256 = {digest}",
                [msgspec.structs.astuple(time_) for time_ in times],
            )

    def tie_times(self, student: str, key: Key) -> None:
        """Tie the times of any work, told under this name, to the work of the key."""
        digest = "row_digest('times', student, exercise, ?1, source, at)"
        with self._transaction():
            self._db.execute(
                f"UPDATE OR REPLACE times SET submission_sha256 = ?1, row_sha256 = {digest}"
                " WHERE student = ?2 AND exercise = ?3 AND submission_sha256 = ''",
                (key.submission_sha256, student, key.exercise),
            )

    def times(self) -> Iterator[SubmittedAt]:
        """All known times of submission."""
        with explained(self.path):
            for row in self._db.execute("SELECT student, exercise, submission_sha256, source, at FROM times"):
                yield _as(SubmittedAt, row)

    # -- results --------------------------------------------------------------------------------------

    def add(self, result: Result, files: Mapping[str, bytes] | None = None) -> Result:
        """Store a result, now with its time, and its submission; both are in the file when this returns."""
        result = replace(result, graded_at=result.graded_at or _now())
        body = msgspec.json.encode(finite(msgspec.to_builtins(result.verdict)))
        row = (self._run, *asdict(result.key).values(), result.graded_at, body, _sha256(body))
        with self._transaction():
            self._db.execute(row_into("results", "INSERT OR REPLACE"), (self._next("results"), *row))
            if files is not None:
                self._keep(result.key.submission_sha256, files)
        return result

    def _keep(self, sha256: str, files: Mapping[str, bytes]) -> None:
        packed = _masked(zlib.compress(msgspec.msgpack.encode(dict(files)), 1), os.urandom(_SALT))
        self._db.execute(row_into("submissions", "INSERT OR IGNORE"), (sha256, packed))

    def take_back(self, key: Key, verdict: Verdict) -> None:
        """Let no result count for a student and exercise any more; all are kept.

        Args:
            key: of the result that counts.
            verdict: that nothing was handed in, for a version that knows no such rows.
        """
        self.add(Result(replace(key, submission_sha256="", grader_version=""), verdict))

    def restore(self, sha256: str, files: Mapping[str, bytes]) -> None:
        """Store the submission of a result, if it was lost."""
        if not self._rows("SELECT 1 FROM submissions WHERE sha256 = ?", sha256):
            with self._transaction():
                self._keep(sha256, files)

    def _next(self, table: str) -> int:
        newest = self._db.execute(f"SELECT ifnull(max(number), 0) FROM {table}").fetchone()
        return int(newest[0]) + 1

    def confirm(self, key: Key, moving: AbstractContextManager[None] | None = None) -> bool:
        """Whether this very submission was graded; if so, make that the newest result of its student again.

        A student who hands in an earlier version again gets the score of that version. A result of other
        graders than the key's counts too, so that nothing is graded again without need.

        Args:
            moving: entered while another result becomes the newest.
        """
        number = self._find(key)
        if number is None:
            return False
        query = "SELECT max(number) FROM results WHERE student = ? AND exercise = ?"
        if self._rows(query, key.student, key.exercise) != [(number,)]:
            with moving or contextlib.nullcontext(), self._transaction():
                self._db.execute(
                    "UPDATE results SET number = ?1, row_sha256 = row_digest('results', ?1, run, student,"
                    " exercise, submission_sha256, grader_version, seed, graded_at, verdict, verdict_sha256)"
                    " WHERE number = ?2",
                    (self._next("results"), number),
                )
        return True

    def _find(self, key: Key) -> int | None:
        with explained(self.path):
            row = self._db.execute(
                "SELECT number, verdict FROM results WHERE student = ? AND exercise = ?"
                " AND submission_sha256 = ? AND seed = ? ORDER BY number DESC LIMIT 1",
                (key.student, key.exercise, key.submission_sha256, key.seed),
            ).fetchone()
            if row is None or msgspec.json.decode(row[1], type=_State).state == "grader_error":
                return None
        return int(row[0])

    def results(self, student: str | None = None, exercise: str | None = None) -> Iterator[Result]:
        """The newest result of each student and exercise, ordered by both."""
        where, arguments = _about(student, exercise)
        newest = f"number IN (SELECT max(number) FROM results{where} GROUP BY student, exercise)"
        yield from self._results(f" WHERE {newest} AND {_NOT_TAKEN_BACK}", arguments)

    def verify(self) -> None:
        """Look at every page, every decision, and all that opening leaves unread because it is large.

        Raises:
            IntegrityError: the file is damaged.
        """
        with explained(self.path):
            told = self._db.execute("PRAGMA quick_check(1)").fetchone()[0]
            if told != "ok":
                raise sqlite3.DatabaseError(told)
            with_digests = self._db.execute("PRAGMA user_version").fetchone()[0] >= 4
            for name, (about, words) in _LARGE.items() if with_digests else ():
                other = f"row_sha256 != row_digest('{name}', {', '.join(TABLES[name])})"
                row = self._db.execute(f"SELECT {about} FROM {name} WHERE {other} LIMIT 1").fetchone()
                if row is not None:
                    raise _failed_checksum(words.format(*row), self.path)
        self.overrides()

    def history(self, student: str, exercise: str) -> list[Result]:
        """Every result of a student and exercise, oldest first."""
        where, arguments = _about(student, exercise)
        return list(self._results(f"{where} AND {_NOT_TAKEN_BACK}", arguments))

    def _results(self, where: str, arguments: tuple[str, ...]) -> Iterator[Result]:
        query = (
            "SELECT student, exercise, submission_sha256, grader_version, seed, graded_at, run, number,"
            f" verdict, verdict_sha256 FROM results{where} ORDER BY student, exercise, number"
        )
        with explained(self.path):
            for row in self._db.execute(query, arguments):
                *key, graded_at, run, number, body, digest = row
                if _sha256(body) != digest:
                    raise _failed_checksum(f"The result of {key[0]!r} for {key[1]}", self.path)
                verdict = msgspec.json.decode(body, type=Verdict)
                yield Result(_as(Key, key), verdict, str(graded_at), int(run), int(number))

    def student_ids(self) -> list[str]:
        """All students with a result, by name."""
        newest = "SELECT max(number) FROM results GROUP BY student, exercise"
        where = f"number IN ({newest}) AND {_NOT_TAKEN_BACK}"
        query = f"SELECT DISTINCT student FROM results WHERE {where} ORDER BY 1"
        return [student for (student,) in self._rows(query)]

    def exercise_ids(self, *, handed_in: bool = False) -> list[str]:
        """All exercises with a result, by name; or those alone of which there is a submission."""
        query = "SELECT DISTINCT exercise FROM results WHERE submission_sha256 IS NOT ? ORDER BY 1"
        nothing = hashlib.sha256().hexdigest() if handed_in else None
        return [exercise for (exercise,) in self._rows(query, nothing)]

    def without_work(self) -> list[str]:
        """The students whose folder held nothing to grade."""
        with explained(self.path):
            return msgspec.json.decode(self.meta().get("without_work", "[]"), type=list[str])

    def looked(self) -> dict[str, Looked] | None:
        """By exercise, whose work was looked at; None in a gradebook of a version that did not note it."""
        text = self.meta().get("looked")
        with explained(self.path):
            return msgspec.json.decode(text, type=dict[str, Looked]) if text is not None else None

    def set_looked(self, looked: Mapping[str, Looked]) -> None:
        self.set_meta(looked=msgspec.json.encode(looked, order="deterministic").decode())

    def submission(self, sha256: str) -> dict[str, bytes] | None:
        """A submission: file name to content; None if none has that digest."""
        rows = self._rows("SELECT files FROM submissions WHERE sha256 = ?", sha256)
        if not rows:
            return None
        try:
            stored = rows[0][0]
            if stored[:1] == _MASK:
                stored = _masked(stored[1 + _SALT :], stored[1 : 1 + _SALT])[1 + _SALT :]
            files = zlib.decompressobj().decompress(stored, _MOST_UNPACKED)
            return msgspec.msgpack.decode(files, type=dict[str, bytes])
        except (zlib.error, msgspec.DecodeError, TypeError):
            raise _failed_checksum(f"The submission {sha256[:12]}", self.path) from None

    # -- what an instructor decided -------------------------------------------------------------------

    def add_override(self, override: Override, before: str = "") -> None:
        """Store a decision, here and in the journal; earlier ones are kept.

        Args:
            before: what counted before, for the journal.
        """
        at = override.at or _now()
        row = (override.student, override.exercise, override.score, override.reason, at)
        with self._transaction():
            number = self._next("overrides")
            self._db.execute(row_into("overrides"), (number, *row, override_digest(*row)))
            after = msgspec.json.encode({"number": number, "score": override.score}).decode()
            kind = "lift" if override.score is None else "override"
            about = (override.student, override.exercise, override.reason, before, after)
            self._db.execute(row_into("journal"), (self._next("journal"), at, whoami(), kind, *about))

    def overrides(self) -> list[Override]:
        """Every decision, oldest first, lifted ones included."""
        found: list[Override] = []
        query = "SELECT student, exercise, score, reason, at, sha256 FROM overrides ORDER BY number"
        with explained(self.path):
            for *row, digest in self._db.execute(query):
                one = _as(Override, row)
                if override_digest(*row) != digest:
                    raise _failed_checksum(f"The override for {row[0]!r} and {row[1]}", self.path)
                found.append(one)
        return found

    def note(self, decision: Decision) -> None:
        """Record who changed a grade, when, why, and what it was before."""
        with self._transaction():
            number = self._next("journal")
            at, who = decision.at or _now(), decision.who or whoami()
            row = msgspec.structs.astuple(msgspec.structs.replace(decision, at=at, who=who))
            self._db.execute(row_into("journal"), (number, *row))

    def journal(self, student: str | None = None, exercise: str | None = None) -> list[Decision]:
        """Every change of a grade, oldest first; those about a class are about each of its students."""
        with explained(self.path):
            rows = self._db.execute(
                "SELECT at, who, kind, student, exercise, reason, before, after FROM journal"
                " WHERE student IN ('', ifnull(?1, student)) AND exercise IN ('', ifnull(?2, exercise))"
                " ORDER BY number",
                (student, exercise),
            ).fetchall()
            return [_as(Decision, row) for row in rows]

    def set_waiting(self, students: Iterable[str], *, others: bool) -> None:
        """Note whose work a run has still to look at.

        Args:
            others: those who waited before go on waiting.
        """
        with self._transaction():
            if not others:
                self._db.execute("DELETE FROM waiting")
            self._db.executemany(row_into("waiting", "INSERT OR REPLACE"), [(name,) for name in students])

    def settle(self, student: str) -> None:
        """Note that all of a student's work was looked at, and what there was of it is graded."""
        with self._transaction():
            self._db.execute("DELETE FROM waiting WHERE student = ?", (student,))

    def waiting(self) -> set[str]:
        """The students whose work was not all looked at: a run is going on, or was interrupted."""
        return {student for (student,) in self._rows("SELECT student FROM waiting")}

    # -- graders, and what was found ------------------------------------------------------------------

    def keep_snapshot(self, sha256: str, packed: bytes) -> None:
        """Store the graders of a run; equal ones are stored once."""
        with self._transaction():
            self._db.execute(row_into("snapshots", "INSERT OR IGNORE"), (sha256, packed))

    def snapshot(self, sha256: str) -> bytes | None:
        """The packed graders of that digest; None if they are not here."""
        rows = self._rows("SELECT packed FROM snapshots WHERE sha256 = ?", sha256)
        return bytes(rows[0][0]) if rows else None

    def set_found(self, student: str, exercise: str, listed: str | None) -> None:
        """Record a student's files that may be meant for an exercise; None once that is settled."""
        with self._transaction():
            if listed is None:
                self._db.execute("DELETE FROM found WHERE student = ? AND exercise = ?", (student, exercise))
            else:
                self._db.execute(row_into("found", "INSERT OR REPLACE"), (student, exercise, listed))

    def found(self) -> dict[tuple[str, str], str]:
        """The recorded files, by student and exercise."""
        rows = self._rows("SELECT student, exercise, listed FROM found ORDER BY 1, 2")
        return {(student, exercise): listed for student, exercise, listed in rows}

    def _rows(self, query: str, *arguments: str | None) -> list[Any]:
        with explained(self.path):
            return self._db.execute(query, arguments).fetchall()

    # -- writing --------------------------------------------------------------------------------------

    @contextlib.contextmanager
    def _transaction(self) -> Iterator[None]:
        """A transaction, whose time is counted."""
        start = time.perf_counter()
        with explained(self.path):
            if self._writing and not self._begun:
                file.begin_writing(self._db)
                self._begun = True
            self._db.execute("BEGIN IMMEDIATE")
            try:
                if not self._changed:
                    file.unseal(self._db)
                yield
                self._db.execute("COMMIT")
                self._changed = True
            except BaseException:
                with contextlib.suppress(sqlite3.Error):
                    self._db.execute("ROLLBACK")
                raise
            if self._begun and time.monotonic() > self._checkpoint_at:
                self._db.execute("PRAGMA wal_checkpoint(PASSIVE)")
                self._checkpoint_at = time.monotonic() + _CHECKPOINT_S
        self.write_s += time.perf_counter() - start


#: The newest row of a student and exercise may say that no result counts: it names no submission.
_NOT_TAKEN_BACK = "submission_sha256 != ''"


class _State(msgspec.Struct):
    """The one field of a verdict that decides whether it is kept."""

    state: str


def _about(student: str | None, exercise: str | None) -> tuple[str, tuple[str, ...]]:
    """A condition on student and exercise, with its parameters; empty where both are None."""
    asked = {"student = ?": student, "exercise = ?": exercise}
    asked = {condition: value for condition, value in asked.items() if value is not None}
    where = f" WHERE {' AND '.join(asked)}" if asked else ""
    return where, tuple(map(str, asked.values()))


#: Tables with contents that the seal does not cover: what names a row of them, and how it is called.
_LARGE = {
    "results": ("student, exercise", "The result of {!r} for {}"),
    "submissions": ("sha256", "The submission {:.12}"),
    "snapshots": ("sha256", "The snapshot {:.12} of the graders"),
}


def _failed_checksum(what: str, path: Path) -> IntegrityError:
    return IntegrityError(f"{what} in {path} fails its checksum.", help=rescue(path))


def _sha256(body: bytes | str) -> str:
    # A file edited by hand may have text where bytes were: that is damage, and must not crash.
    return hashlib.sha256(body.encode() if isinstance(body, str) else body).hexdigest()


class _Options(msgspec.Struct):
    """What is used of a run's options, and what each of them is."""

    snapshot: str | None = None
    folder: str = ""
    timeout: float = 10.0
    level: str | None = None
    at_least: str = ""
    reason: str = ""
    who: str = ""


def _options(text: str) -> dict[str, Any]:
    msgspec.json.decode(text, type=_Options)
    return msgspec.json.decode(text, type=dict[str, Any])


def _as(kind: type[T], row: Iterable[object]) -> T:
    """A row as a type: whoever wrote the file may have put anything into a column."""
    names = [field.name for field in msgspec.inspect.type_info(kind).fields]  # type: ignore[attr-defined]
    return msgspec.convert(dict(zip(names, row, strict=False)), kind)


def whoami() -> str:
    """The name of the account that this runs under; its number where it has none."""
    try:
        return getpass.getuser()
    except (OSError, KeyError, ImportError):
        return str(os.getuid()) if hasattr(os, "getuid") else "unknown"


def _now() -> str:
    return time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime())
