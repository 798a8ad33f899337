"""What is got out of a damaged gradebook: every whole row and every override, whichever page is damaged."""

from __future__ import annotations

import contextlib
import random
import shutil
import sqlite3
from pathlib import Path

import pytest

from course.errors import IntegrityError, NotFoundError, UsageError
from course.grading.gradebook.book import Gradebook
from course.grading.gradebook.file import _know_digests
from course.grading.gradebook.records import (
    Decision,
    GradedExercise,
    Override,
    PlatformIdentity,
    Result,
    SubmittedAt,
)
from course.grading.gradebook.salvage import back_up, backups, raw_rows, salvage
from tests.unit.grading.test_gradebook import key, verdict

STUDENTS = 12
PAGE = 4096


def small_book(path: Path) -> None:
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


def rows(path: Path) -> dict[str, set]:
    with Gradebook(path) as book:
        return {
            "results": {(result.key, result.graded_at) for result in book.results()},
            "overrides": {(one.student, one.score, one.reason, one.at) for one in book.overrides()},
            "submissions": {name for name in range(STUDENTS) if book.submission(f"{name:064}") is not None},
            "times": set(book.times()),
            "students": set(book.students()),
        }


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("whole") / "gradebook.sqlite"
    small_book(path)
    return path


@pytest.mark.parametrize(
    "how", ["zeros", pytest.param("noise", marks=pytest.mark.soak), "one bit of every cell"]
)
def test_with_any_page_damaged_every_override_and_every_other_row_is_there(
    tmp_path: Path, whole: Path, how: str
) -> None:
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
    tmp_path: Path, score: float
) -> None:
    """`--score -0` was kept as 0, which failed its checksum in this file and in the salvaged one."""
    path = tmp_path / "gradebook.sqlite"
    with Gradebook(path, create=True, writing=True) as book:
        book.add_override(Override("ada", "doubling", score, "x"))
    with contextlib.closing(
        sqlite3.connect(path)
    ) as db:  # as that version wrote it: an own digest that is wrong
        _know_digests(db)
        row = "'overrides', number, student, exercise, score, reason, at, sha256"
        db.execute("DELETE FROM meta")
        for sql in ("sha256 = 'x'", f"row_sha256 = row_digest({row})"):
            db.execute(f"UPDATE overrides SET {sql}")
        db.commit()
    with Gradebook(path) as book, pytest.raises(IntegrityError, match="fails its checksum"):
        book.overrides()
    salvage(path, tmp_path / "new.sqlite")
    with Gradebook(tmp_path / "new.sqlite") as book:
        assert [str(one.score) for one in book.overrides()] == [str(abs(float(score)))]


def test_with_a_backup_beside_it_nothing_is_lost(tmp_path: Path, whole: Path) -> None:
    data, due = whole.read_bytes(), rows(whole)
    path = tmp_path / "gradebook.sqlite"
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


def test_without_anything_whole_it_is_refused_and_nothing_is_left(tmp_path: Path, whole: Path) -> None:
    with pytest.raises(NotFoundError):
        salvage(tmp_path / "none.sqlite", tmp_path / "new.sqlite")
    (tmp_path / "noise.sqlite").write_bytes(random.Random(3).randbytes(40 * PAGE))
    with pytest.raises(IntegrityError):
        salvage(tmp_path / "noise.sqlite", tmp_path / "new.sqlite")
    assert not (tmp_path / "new.sqlite").exists()
    with pytest.raises(UsageError):
        salvage(whole, whole)


def test_hostile_pages_are_read_to_their_end() -> None:
    """Lengths, pointers and chains that lie: no error, no loop, no memory."""
    dice = random.Random(4)
    for _ in range(300):
        page = bytearray(dice.randbytes(PAGE))
        page[0] = dice.choice([0x0D, 0x0A, 0x02])
        other = bytearray(page)
        other[0:4] = (1).to_bytes(4, "big")
        for _row in raw_rows(bytes(page + other)):
            pass


def test_backups_rotate_and_what_was_deleted_stays_deleted(tmp_path: Path) -> None:
    path = tmp_path / "gradebook.sqlite"
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
