"""The one truth of a grading run survives what happens to files."""

import contextlib
import hashlib
import random
import shutil
import sqlite3
import subprocess
import sys
import zlib
from pathlib import Path

import msgspec
import pytest

from course.errors import IntegrityError, MissingCapabilityError, NotFoundError, UsageError
from course.grading.gradebook.book import Gradebook
from course.grading.gradebook.file import FORMAT_VERSION, _know_digests
from course.grading.gradebook.records import (
    Decision,
    GradedExercise,
    Key,
    Override,
    PlatformIdentity,
    Result,
    SubmittedAt,
)
from course.grading.gradebook.salvage import back_up, backups, raw_rows, salvage
from course.scoring.verdict import CheckResult, Problem, Status, Verdict, Visibility

ROOT = Path(__file__).resolve().parents[3]


def key(student="ada", digest="a" * 64):
    return Key(student, "doubling", digest, "v1", 7)


def verdict(score=5.0, state="graded", actual=None):
    check = CheckResult(
        id="c", title="t", task="double", status=Status.FAIL, visibility=Visibility.HIDDEN, points=0,
        max_points=2, actual=actual,
    )  # fmt: skip
    return Verdict(
        exercise="doubling", scope="full", state=state, score=score, max_score=10, passed=False,
        checks=(check,), isolation="L3", error=Problem("x", "y") if state != "graded" else None,
    )  # fmt: skip


@pytest.fixture
def path(tmp_path):
    """Where the gradebook of a test lies."""
    return tmp_path / "gradebook.sqlite"


def sql(path, *statements):
    """Change a gradebook behind its back; how many rows each statement found."""
    with contextlib.closing(sqlite3.connect(path)) as db, db:
        _know_digests(db)
        return [db.execute(statement).rowcount for statement in statements]


FILES = {"doubling.py": b"\xff\x00 not text", "b.py": b""}
EXERCISES = [GradedExercise("b", "B", 2.0, 0.7, 2), GradedExercise("a", "A", 3.0, 0.5, 3)]


def full(path):
    """A gradebook with something in every table."""
    with Gradebook(path, create=True) as book:
        book.set_meta(seed="7", roster="[]")
        book.begin_run("run", {"timeout": 10.0})
        book.set_exercises(EXERCISES)
        book.set_students({"ada": PlatformIdentity("canvas", "1", "ada")})
        book.add(Result(key(), verdict(actual=[float("nan"), float("inf"), -float("inf")])), FILES)
        book.add_times([SubmittedAt("ada", "doubling", "a", "mtime", 200.0)])
        book.add_override(Override("ada", "doubling", 5.0, "first"))


def test_what_is_kept_comes_back_as_it_went_in(path):
    """Numbers that JSON has not come back as words."""
    with pytest.raises(NotFoundError):
        Gradebook(path)
    assert not path.exists(), "looking creates none"
    full(path)
    with Gradebook(path) as book:
        (found,) = book.results()
        assert (found.key, found.verdict) == (key(), verdict(actual=["nan", "inf", "-inf"]))
        assert found.graded_at.endswith("Z")
        assert (book.submission("a" * 64), book.submission("b" * 64)) == (FILES, None)
        assert book.meta()["seed"] == "7"
        assert list(book.exercises()) == EXERCISES
        assert book.students() == {"ada": PlatformIdentity("canvas", "1", "ada")}


@pytest.mark.parametrize("content", [b"this is no database, but it is long enough to be one" * 20, b""])
def test_what_is_no_gradebook_is_said_to_be_none(path, content):
    path.write_bytes(content)
    with pytest.raises(IntegrityError):
        Gradebook(path)
    assert path.read_bytes() == content


def test_a_changed_result_fails_its_checksum_and_names_the_student(path):
    with Gradebook(path, create=True) as book:
        book.add(Result(key(), verdict()))
    sql(path, "UPDATE results SET verdict = replace(verdict, '5.0', '9.0')")
    with Gradebook(path) as book, pytest.raises(IntegrityError, match="'ada'"):
        list(book.results())


def test_grading_anew_keeps_the_old_result_beside_the_new(path):
    with Gradebook(path, create=True) as book:
        book.begin_run("run", {"timeout": 3.0})
        book.add(Result(key(), verdict(1)))
        book.add(Result(key(), verdict(2)))
        assert [old.verdict.score for old in book.history("ada", "doubling")] == [2]
        book.begin_run("rerun", {})
        book.add(Result(key(), verdict(3)))
        assert [(old.run, old.verdict.score) for old in book.history("ada", "doubling")] == [(1, 2), (2, 3)]
        (newest,) = book.results()
        assert newest.verdict.score == 3


def test_handing_in_an_earlier_version_again_makes_its_score_count_again(path):
    def counts():
        return [result.verdict.score for result in book.results()]

    with Gradebook(path, create=True) as book:
        book.add(Result(key(digest="a" * 64), verdict(1, state="grader_error")))
        assert not book.confirm(key(digest="a" * 64)), "a fault of ours does not count as graded"
        book.add(Result(key(digest="a" * 64), verdict(1)))
        book.add(Result(key(digest="b" * 64), verdict(2)))
        assert counts() == [2]
        assert book.confirm(key(digest="a" * 64))
        assert not book.confirm(key(digest="c" * 64))
        assert counts() == [1]
        book.add(Result(key(digest="c" * 64), verdict(3)))
        assert counts() == [3]


_KILLED = """
import os, sys
from pathlib import Path
from tests.unit.grading.test_gradebook import Gradebook, Result, key, verdict
book = Gradebook(Path(sys.argv[1]), create=True, writing=True)
for number in range(30):
    book.add(Result(key(f"student {number}"), verdict(number)))
os._exit(9)
"""


def test_a_reported_result_survives_the_death_of_its_process(tmp_path, path):
    """The writer ends without closing anything; whoever looks next puts things in order."""
    assert subprocess.run([sys.executable, "-c", _KILLED, path], cwd=ROOT, check=False).returncode == 9
    assert (tmp_path / "gradebook.sqlite-wal").exists()
    with Gradebook(path) as book:
        assert len(list(book.results())) == 30
    assert [item.name for item in tmp_path.iterdir()] == ["gradebook.sqlite"]


def test_of_two_that_make_one_gradebook_the_second_is_told(tmp_path, path):
    with Gradebook(path, create=True, writing=True) as book:
        with pytest.raises(UsageError, match="Another run"):
            Gradebook(path, create=True, writing=True)
        book.add(Result(key(), verdict()))
    with Gradebook(path) as book:
        assert len(list(book.results())) == 1
    assert [item.name for item in tmp_path.iterdir()] == ["gradebook.sqlite"]


def test_a_full_disk_is_said_plainly_and_what_was_kept_stays(path):
    added = []

    def fill():
        with Gradebook(path, create=True, writing=True) as book:
            book._db.execute("PRAGMA max_page_count = 40")
            for number in range(1000):
                book.add(Result(key(f"student {number}"), verdict()))
                added.append(number)

    with pytest.raises(MissingCapabilityError, match="disk is full") as caught:
        fill()
    kept = len(added)
    assert caught.value.exit_code == 4
    assert "--resume" in caught.value.help
    assert 10 < kept < 1000
    with Gradebook(path, writing=True) as book:
        assert len(list(book.results())) == kept
        book.add(Result(key("one more"), verdict()))


def test_a_gradebook_of_the_first_format_is_brought_up_to_date(path):
    body = msgspec.json.encode(verdict(4))
    sql(
        path,
        "CREATE TABLE meta (key TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID",
        "CREATE TABLE results (number INTEGER PRIMARY KEY, student TEXT NOT NULL, exercise TEXT NOT NULL,"
        " submission_sha256 TEXT NOT NULL, grader_version TEXT NOT NULL, seed INTEGER NOT NULL,"
        " late REAL, graded_at TEXT NOT NULL, verdict BLOB NOT NULL, verdict_sha256 TEXT NOT NULL,"
        " UNIQUE (student, exercise, submission_sha256, grader_version, seed))",
        "INSERT INTO meta VALUES ('seed', '7')",
        f"INSERT INTO results VALUES (3, 'ada', 'doubling', '{'a' * 64}', 'v1', 7, NULL, 'then',"
        f" x'{body.hex()}', '{hashlib.sha256(body).hexdigest()}')",
        "PRAGMA user_version = 1",
        "PRAGMA application_id = 1668248179",
    )
    for _ in range(2):
        with Gradebook(path) as book:
            (found,) = book.results()
            assert (found.key, found.verdict.score, found.graded_at) == (key(), 4, "then")
            assert book.confirm(key())
            assert book.meta()["seed"] == "7"


def test_what_an_instructor_decided_is_kept_in_order_and_checked(path):
    with Gradebook(path, create=True) as book:
        book.add_override(Override("ada", "doubling", 5.0, "first"))
        book.add_override(Override("ada", "doubling", None, ""))
        assert [(item.score, item.reason) for item in book.overrides()] == [(5.0, "first"), (None, "")]
    unsealed = "DELETE FROM meta WHERE key = 'seal'"  # as if a run had been killed since
    sql(path, "UPDATE overrides SET score = 10.0 WHERE number = 1", unsealed)
    with Gradebook(path) as book, pytest.raises(IntegrityError, match="override"):
        book.overrides()


@pytest.mark.parametrize(
    "change",
    [
        "UPDATE meta SET value = '[{]' WHERE key = 'roster'",
        "UPDATE meta SET key = 'rosteR' WHERE key = 'roster'",
        "UPDATE runs SET options = '{}'",
        "UPDATE exercises SET pass_share = 0.5",
        "UPDATE students SET student = 'adb'",
        "UPDATE times SET at = 201.0",
        "UPDATE overrides SET reason = 'firsu'",
        "UPDATE results SET student = 'adb'",
        "UPDATE results SET graded_at = '2026'",
        "UPDATE submissions SET sha256 = 'b'",
        "DELETE FROM results",
        "UPDATE times SET student = CAST(x'ff41' AS TEXT)",
    ],
)
def test_what_changed_since_it_was_closed_is_damage(path, change):
    full(path)
    Gradebook(path).close()
    assert sql(path, change)[0] >= 1
    for writing in (False, True):
        with pytest.raises(IntegrityError, match="damaged"):
            Gradebook(path, writing=writing)


@pytest.mark.parametrize(
    "change",
    [
        "UPDATE results SET verdict = CAST(verdict || 'x' AS BLOB)",
        "UPDATE submissions SET files = CAST(files || 'x' AS BLOB)",
        "UPDATE snapshots SET packed = CAST(packed || 'x' AS BLOB)",
    ],
)
def test_what_is_too_large_to_be_read_at_every_opening_is_read_by_who_looks_at_everything(path, change):
    full(path)
    with Gradebook(path, writing=True) as book:
        book.keep_snapshot("5" * 64, b"graders")
    with Gradebook(path) as book:
        book.verify()
    assert sql(path, change)[0] >= 1
    with Gradebook(path) as book, pytest.raises(IntegrityError, match="fails its checksum"):
        book.verify()


#: Makes of a gradebook what the format before had: rows without digests, and four tables fewer.
BEFORE_4 = [
    *(
        f"ALTER TABLE {table} DROP COLUMN row_sha256"
        for table in ("meta", "runs", "exercises", "students", "submissions", "times", "overrides", "results")
    ),
    *(f"DROP TABLE {table}" for table in ("snapshots", "found", "journal", "waiting")),
]


def test_a_gradebook_without_a_seal_is_read_and_sealed_by_the_next_who_writes(path):
    """A run that was killed leaves none, and neither did the format before."""
    full(path)
    changes = ["DELETE FROM meta WHERE key = 'seal'", "UPDATE exercises SET pass_share = 0.6"]
    sql(path, *changes, *BEFORE_4, "PRAGMA user_version = 2")
    with Gradebook(path) as book:
        assert book.exercises()[0].pass_share == 0.6
    with Gradebook(path, writing=True) as book:
        book.set_meta(late_policy="x")
        assert book.meta() == {"seed": "7", "roster": "[]", "late_policy": "x"}
    with contextlib.closing(sqlite3.connect(path)) as db:
        assert db.execute("PRAGMA user_version").fetchone()[0] == FORMAT_VERSION
    sql(path, "UPDATE exercises SET pass_share = 0.7")
    with pytest.raises(IntegrityError, match="damaged"):
        Gradebook(path)


def test_of_one_witness_the_earliest_time_of_a_content_stays(path):
    with Gradebook(path, create=True) as book:
        for at in (200.0, 100.0, 300.0, None):
            book.add_times([SubmittedAt("ada", "doubling", "a", "mtime", at)])
        book.add_times([SubmittedAt("ada", "doubling", "", "list", 5.0)])
        book.add_times([SubmittedAt("ada", "doubling", "", "list", 9.0)], replace=True)
        assert {(time.source, time.at) for time in book.times()} == {("mtime", 100.0), ("list", 9.0)}


# -- what is got out of a damaged one, whichever page is damaged ---------------------------------------------

STUDENTS = 12
PAGE = 4096


def small_book(path):
    """Something in every table; rows of results that fit on a page each, and some that need more."""
    with Gradebook(path, create=True, writing=True) as book:
        book.set_meta(seed="7", roster="[]", late_policy="x" * 9000)
        book.keep_snapshot("5" * 64, random.Random(1).randbytes(9000))
        book.begin_run("run", {"timeout": 10.0, "snapshot": "5" * 64})
        book.set_exercises([GradedExercise("doubling", "Doubling", 10.0, 0.7, 1)])
        for number in range(STUDENTS):
            name = f"student {number}"
            book.set_students({name: PlatformIdentity("canvas", str(number), name)})
            book.add(
                Result(key(name, f"{number:064}"), verdict(number % 11)), {"doubling.py": b"%d" % number}
            )
            book.add_times([SubmittedAt(name, "doubling", f"{number:064}", "mtime", 200.5)])
        for number in range(5):
            book.add_override(Override(f"student {number}", "doubling", 5.0 + number, f"reason {number}"))
        book.add_override(Override("student 0", "doubling", None, "after all"))
        book.set_found("student 3", "doubling", "[]")
        book.note(Decision("", "", "assign", "student 9", "doubling", "hers", "{}", "{}"))


def rows(path):
    with Gradebook(path) as book:
        return {
            "results": {(result.key, result.graded_at) for result in book.results()},
            "overrides": {(one.student, one.score, one.reason, one.at) for one in book.overrides()},
            "submissions": {name for name in range(STUDENTS) if book.submission(f"{name:064}") is not None},
            "times": set(book.times()),
            "students": set(book.students()),
        }


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    path = tmp_path_factory.mktemp("whole") / "gradebook.sqlite"
    small_book(path)
    return path


@pytest.mark.parametrize(
    "how", ["zeros", pytest.param("noise", marks=pytest.mark.soak), "one bit of every cell"]
)
def test_with_any_page_damaged_every_override_and_every_other_row_is_there(tmp_path, whole, how):
    """No row of these results needs two pages: over all pages each is lost exactly once, and that is said."""
    data, due = whole.read_bytes(), rows(whole)
    assert {len(due["results"]), len(due["times"])} == {STUDENTS}
    noise = random.Random(2)
    lost, said = dict.fromkeys(due, 0), []
    for number in range(len(data) // PAGE):
        page = bytearray(data[number * PAGE : (number + 1) * PAGE])
        if how == "zeros":
            page = bytearray(PAGE)
        elif how == "noise":
            page = bytearray(noise.randbytes(PAGE))
        else:
            for at in range(200, PAGE, 16):
                page[at] ^= 1
        out = tmp_path / str(number)
        out.mkdir()
        (out / "gradebook.sqlite").write_bytes(data[: number * PAGE] + page + data[(number + 1) * PAGE :])
        said += salvage(out / "gradebook.sqlite", out / "new.sqlite").lost
        found = rows(out / "new.sqlite")
        assert found["overrides"] == due["overrides"], number
        for name, mine in found.items():
            assert mine <= due[name], "nothing is made up"
            lost[name] += len(due[name] - mine)
        shutil.rmtree(out)
    assert lost["overrides"] == 0
    assert 0 < lost["results"] <= STUDENTS
    if how != "one bit of every cell":
        assert lost["results"] == lost["times"] == lost["students"] == STUDENTS
        assert sum("the result of student" in one for one in said) >= STUDENTS - 2
        assert sum("handed in for doubling" in one for one in said) == STUDENTS
        assert {"the graders of run 1", "the late policy"} <= set(said)


@pytest.mark.parametrize("score", [-0.0, 0, 5, 7.5])
def test_every_number_that_may_be_a_score_is_read_again_and_one_that_is_not_its_own_is_left_out(
    tmp_path, score, path
):
    """`--score -0` was kept as 0, which failed its checksum in this file and in the salvaged one."""
    with Gradebook(path, create=True, writing=True) as book:
        book.add_override(Override("ada", "doubling", score, "x"))
    # As that version wrote it: an own digest that is wrong.
    row = "'overrides', number, student, exercise, score, reason, at, sha256"
    wrong = ("UPDATE overrides SET sha256 = 'x'", f"UPDATE overrides SET row_sha256 = row_digest({row})")
    sql(path, "DELETE FROM meta", *wrong)
    with Gradebook(path) as book, pytest.raises(IntegrityError, match="fails its checksum"):
        book.overrides()
    salvage(path, tmp_path / "new.sqlite")
    with Gradebook(tmp_path / "new.sqlite") as book:
        assert [str(one.score) for one in book.overrides()] == [str(abs(float(score)))]


def test_bytes_that_are_handed_in_stand_nowhere_in_the_file_as_they_are(tmp_path):
    """zlib keeps what it cannot shorten: pages with a row of one's own would be found by ``salvage``."""
    path, noise = tmp_path / "gradebook.sqlite", random.Random(5).randbytes(4 * PAGE)
    with Gradebook(path, create=True, writing=True) as book:
        book.add(Result(key(), verdict()), {"doubling.py": noise})
    assert noise[PAGE : PAGE + 64] not in path.read_bytes()
    with contextlib.closing(sqlite3.connect(path)) as db:
        (stored,) = db.execute("SELECT files FROM submissions").fetchone()
        as_before = zlib.compress(msgspec.msgpack.encode({"doubling.py": noise}), 1)
        assert noise[PAGE : PAGE + 64] in as_before, "so version 1.2.0 kept it"
        assert len(stored) == len(as_before) + 17
    for kept in (stored, as_before):
        sql(
            path,
            f"UPDATE submissions SET files = x'{kept.hex()}'",
            "UPDATE submissions SET row_sha256 = row_digest('submissions', sha256, files)",
            "DELETE FROM meta",
        )
        with Gradebook(path) as book:
            assert book.submission("a" * 64) == {"doubling.py": noise}


def test_with_a_backup_beside_it_nothing_is_lost(tmp_path, whole, path):
    data, due = whole.read_bytes(), rows(whole)
    path.write_bytes(data)
    back_up(path)
    for number in range(0, len(data) // PAGE, 3):
        path.write_bytes(data[: number * PAGE] + bytes(PAGE) + data[(number + 1) * PAGE :])
        new = tmp_path / f"{number}.sqlite"
        told = salvage(path, new)
        assert rows(new) == due
        assert told.lost == []
    path.unlink()
    assert salvage(path, tmp_path / "gone.sqlite").lost == []
    assert rows(tmp_path / "gone.sqlite") == due


def test_without_anything_whole_it_is_refused_and_nothing_is_left(tmp_path, whole):
    with pytest.raises(NotFoundError):
        salvage(tmp_path / "none.sqlite", tmp_path / "new.sqlite")
    (tmp_path / "noise.sqlite").write_bytes(random.Random(3).randbytes(40 * PAGE))
    with pytest.raises(IntegrityError):
        salvage(tmp_path / "noise.sqlite", tmp_path / "new.sqlite")
    assert not (tmp_path / "new.sqlite").exists()
    with pytest.raises(UsageError):
        salvage(whole, whole)


def test_hostile_pages_are_read_to_their_end():
    """Lengths, pointers and chains that lie: no error, no loop, no memory."""
    dice = random.Random(4)
    for _ in range(300):
        page = bytearray(dice.randbytes(PAGE))
        page[0] = dice.choice([0x0D, 0x0A, 0x02])
        other = bytearray(page)
        other[0:4] = (1).to_bytes(4, "big")
        for _row in raw_rows(bytes(page + other)):
            pass


def test_backups_rotate_and_what_was_deleted_stays_deleted(tmp_path, path):
    small_book(path)
    with Gradebook(path, writing=True) as book:
        for here in ("x" * 500, None):  # pages full of them, and then free pages
            for number in range(60):
                book.set_found(f"student {number}", "doubling", here)
    for number in range(4):
        with Gradebook(path, writing=True) as book:
            book.set_meta(number=str(number), late_policy=None)
        back_up(path)
    newest = []
    for backup in backups(path):
        with Gradebook(backup) as book:
            newest.append(book.meta()["number"])
    assert newest == ["3", "2"]
    salvage(path, tmp_path / "new.sqlite")
    with Gradebook(tmp_path / "new.sqlite") as book:
        assert "late_policy" not in book.meta()
        assert book.found() == {}
