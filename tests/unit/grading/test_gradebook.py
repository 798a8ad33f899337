"""The one truth of a grading run survives what happens to files."""

from __future__ import annotations

import sqlite3
from typing import TYPE_CHECKING

import pytest

from course.errors import IntegrityError, NotFoundError, UsageError
from course.grading.gradebook import Gradebook, Key, Result
from course.grading.verdict import CheckResult, Problem, Status, Verdict, Visibility

if TYPE_CHECKING:
    from pathlib import Path


def key(student: str = "ada", digest: str = "a" * 64) -> Key:
    return Key(student, "doubling", digest, "v1", 7)


def verdict(score: float = 5.0, state: str = "graded", actual: object = None) -> Verdict:
    check = CheckResult(
        id="c", title="t", task="double", status=Status.FAIL, visibility=Visibility.HIDDEN, points=0,
        max_points=2, actual=actual,
    )  # fmt: skip
    return Verdict(
        exercise="doubling", scope="full", state=state, score=score, max_score=10, passed=False,
        checks=(check,), isolation="L3", error=Problem("x", "y") if state != "graded" else None,
    )  # fmt: skip


def test_a_result_comes_back_as_it_went_in(tmp_path: Path) -> None:
    with Gradebook(tmp_path / "g.sqlite", create=True) as book:
        book.add(Result(key(), verdict(), 12.5))
        book.set_meta(seed="7")
    with Gradebook(tmp_path / "g.sqlite") as book:
        (found,) = book.results()
        assert (found.key, found.verdict, found.late) == (key(), verdict(), 12.5)
        assert found.graded_at.endswith("Z")
        assert book.meta()["seed"] == "7"


def test_numbers_that_json_has_not_survive_as_words(tmp_path: Path) -> None:
    with Gradebook(tmp_path / "g.sqlite", create=True) as book:
        book.add(Result(key(), verdict(actual=[float("nan"), float("inf"), -float("inf")])))
        (found,) = book.results()
    assert found.verdict.checks[0].actual == ["nan", "inf", "-inf"]


def test_the_newest_result_counts_and_the_older_one_is_kept(tmp_path: Path) -> None:
    path = tmp_path / "g.sqlite"
    with Gradebook(path, create=True) as book:
        book.add(Result(key(digest="a" * 64), verdict(1)))
        book.add(Result(key(digest="b" * 64), verdict(2)))
        (found,) = book.results()
        assert found.verdict.score == 2
    assert sqlite3.connect(path).execute("SELECT count(*) FROM results").fetchone() == (2,)


def test_a_fault_of_ours_does_not_count_as_graded(tmp_path: Path) -> None:
    with Gradebook(tmp_path / "g.sqlite", create=True) as book:
        book.add(Result(key(), verdict(state="grader_error")))
        assert not book.has(key())
        book.add(Result(key(), verdict()))
        assert book.has(key())
        assert not book.has(key(digest="b" * 64))


def test_a_second_writer_is_told_and_changes_nothing(tmp_path: Path) -> None:
    path = tmp_path / "g.sqlite"
    with Gradebook(path, create=True, writing=True) as book:
        book.add(Result(key(), verdict()))
        book.flush()
        with pytest.raises(UsageError, match="Another run is writing"):
            Gradebook(path, writing=True)
    with Gradebook(path, writing=True) as book:
        assert len(list(book.results())) == 1


def test_a_newer_gradebook_is_refused_and_left_alone(tmp_path: Path) -> None:
    path = tmp_path / "g.sqlite"
    Gradebook(path, create=True).close()
    with sqlite3.connect(path) as db:
        db.execute("PRAGMA user_version = 99")
    before = path.read_bytes()
    with pytest.raises(UsageError, match="newer version"):
        Gradebook(path, writing=True)
    assert path.read_bytes() == before


@pytest.mark.parametrize("content", [b"this is no database, but it is long enough to be one" * 20, b""])
def test_what_is_no_gradebook_is_said_to_be_none(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "g.sqlite"
    path.write_bytes(content)
    with pytest.raises(IntegrityError):
        Gradebook(path)
    assert path.read_bytes() == content


def test_a_changed_result_fails_its_checksum_and_names_the_student(tmp_path: Path) -> None:
    path = tmp_path / "g.sqlite"
    with Gradebook(path, create=True) as book:
        book.add(Result(key(), verdict()))
    with sqlite3.connect(path) as db:
        db.execute("UPDATE results SET verdict = replace(verdict, '5.0', '9.0')")
    with Gradebook(path) as book, pytest.raises(IntegrityError, match="'ada'"):
        list(book.results())


def test_a_missing_gradebook_is_not_created_by_looking(tmp_path: Path) -> None:
    with pytest.raises(NotFoundError):
        Gradebook(tmp_path / "g.sqlite")
    assert not (tmp_path / "g.sqlite").exists()
