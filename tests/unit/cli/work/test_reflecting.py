"""A question in prose: after the checks, answered first, graded by its author, kept and not scored."""

from __future__ import annotations

import io

import pytest

from course.catalog.load import Catalog
from course.cli.frame.console import Console
from course.errors import ContentError

RUBRIC = """format_version = 1
question = "When would you double?"
least_words = 4
points = ["It names a number.", "It says why."]
good_answer = "I double two to get four."
"""
ANSWER = "Whenever half is too little for me."


@pytest.fixture
def passed(students_content, workspace, write):
    """A workspace in which doubling passes and has a question."""
    (students_content / "exercises" / "doubling" / "rubric.toml").write_text(RUBRIC)


def check(course, write):
    write("RIGHT", "RIGHT")
    assert course("check", "doubling").code == 0


def test_the_question_comes_once_the_checks_pass_and_its_answer_once_something_was_written(
    course, passed, write, workspace
):
    ran = course("reflect", "doubling", "--json")
    assert (ran.code, ran.json["error"]["code"]) == (5, "not_passed_yet")
    check(course, write)
    ran = course("reflect", "doubling", "--json")
    assert ran.code == 0
    assert (ran.json["answer"], ran.json["good_answer"], ran.json["points"]) == (None, None, [])
    (workspace / "short.txt").write_text("Dunno.")
    ran = course("reflect", "doubling", "--answer", "short.txt", "--json")
    assert (ran.code, ran.json["error"]["code"]) == (2, "too_short")
    assert course("reflect", "doubling", "--json").json["answer"] is None


def test_what_was_written_and_how_it_was_graded_is_kept(course, passed, write, workspace):
    check(course, write)
    (workspace / "mine.txt").write_text(ANSWER)
    ran = course("reflect", "doubling", "--answer", "mine.txt")
    assert "I double two to get four." in ran.out
    for wrong in ("yes", "yes,maybe", "yes,no,no"):
        assert course("reflect", "doubling", "--grades", wrong).code == 2
    assert course("reflect", "doubling", "--grades", "yes, No").code == 0
    body = course("reflect", "doubling", "--json").json
    assert body["answer"] == ANSWER
    assert [point["grade"] for point in body["points"]] == ["yes", "no"]
    (workspace / "mine.txt").write_text(ANSWER + " And more.")
    body = course("reflect", "doubling", "--answer", "mine.txt", "--json").json
    assert [point["grade"] for point in body["points"]] == [None, None], "another answer, not graded yet"


def test_it_changes_no_score_and_is_not_handed_in(course, passed, write, workspace):
    import zipfile

    check(course, write)
    before = course("progress", "--json").json["exercises"]
    (workspace / "mine.txt").write_text(ANSWER)
    course("reflect", "doubling", "--answer", "mine.txt", "--grades", "no,no")
    assert course("progress", "--json").json["exercises"] == before
    course("submit", "-o", "mine.zip")
    with zipfile.ZipFile(workspace / "mine.zip") as archive:
        assert not any(ANSWER.encode() in archive.read(name) for name in archive.namelist())


def test_in_a_terminal_it_is_typed_and_graded_point_by_point(course, passed, write, monkeypatch):
    check(course, write)
    monkeypatch.setattr(Console, "interactive", property(lambda self: not self.json))
    monkeypatch.setattr("sys.stdin", io.StringIO(f"{ANSWER}\n\nperhaps\ny\npartly\n"))
    assert course("reflect", "doubling").code == 0
    body = course("reflect", "doubling", "--json").json
    assert [point["grade"] for point in body["points"]] == ["yes", "partly"]


def test_an_exercise_without_a_question_says_which_have_one(course, passed):
    ran = course("reflect", "halving")
    assert ran.code == 5
    assert "doubling" in ran.err


def test_a_rubric_whose_answer_is_too_short_is_refused(students_content):
    (students_content / "exercises" / "doubling" / "rubric.toml").write_text(
        RUBRIC.replace("least_words = 4", "least_words = 40")
    )
    catalog = Catalog()
    with pytest.raises(ContentError, match="fewer than 40 words"):
        catalog.rubric(catalog.exercise("doubling"))


@pytest.mark.parametrize("exercise_id", ["engine-comparison", "sim-to-real"])
def test_the_chapters_exercises_one_and_three_have_a_question(exercise_id):
    catalog = Catalog()
    exercise = catalog.exercise(exercise_id)
    rubric = catalog.rubric(exercise)
    assert exercise.number in {1, 3}
    assert len(rubric.points) >= 3
