"""A gradebook of somebody else's holds programs; they run only after the person who grades has agreed."""

import json
import shutil

import pytest

from course.cli.frame.console import Console
from course.grading.running import batch
from tests.unit.cli.grade.test_grade_settling import SOURCE
from tests.unit.grading.conftest import MINI
from tests.unit.grading.running.test_run import right

RUN = ("grade", "run", "class", "--out", "out", "--exercise", "doubling")
WAYS = {
    "resume": (*RUN, "--resume"),
    "rerun": ("grade", "rerun", "out", "--against", "1", "--all", "--dry-run"),
    "assign": ("grade", "assign", "out", "bob", "hw.py", "--reason", "it is his", "--dry-run"),
}


@pytest.fixture
def ran(course, tmp_path, monkeypatch):
    """A gradebook from elsewhere: its graders were others, and nothing here knows them. What they grade."""
    graded = []

    def noting(entries, terms, graders):
        for done in right(entries, terms):
            graded.append(done.entry.student)
            yield done

    monkeypatch.setattr(batch, "grade_all", noting)
    shutil.copytree(MINI, tmp_path / "content")
    monkeypatch.setenv("COURSE_CONTENT", str(tmp_path / "content"))
    for student, name in (("ada", "doubling.py"), ("bob", "hw.py")):
        (tmp_path / "class" / student).mkdir(parents=True)
        (tmp_path / "class" / student / name).write_text(SOURCE)
    monkeypatch.setenv("COURSE_CACHE", str(tmp_path / "elsewhere"))
    monkeypatch.setenv("LOGNAME", "eve")
    assert course(*RUN).code == 6
    monkeypatch.setenv("COURSE_CACHE", str(tmp_path / "here"))
    checks = tmp_path / "content" / "graders" / "doubling" / "checks.py"
    checks.write_text(checks.read_text() + "# theirs were others\n")
    (tmp_path / "class" / "cy").mkdir()
    (tmp_path / "class" / "cy" / "doubling.py").write_text(SOURCE)
    graded.clear()
    return graded


@pytest.mark.parametrize("words", WAYS.values(), ids=WAYS)
def test_somebody_elses_graders_run_where_nobody_can_be_asked_only_with_yes(course, ran, words):
    refused = course(*words, "--json")
    error = json.loads(refused.out)["error"]
    assert (refused.code, error["code"], ran) == (2, "foreign_graders", [])
    assert "eve began the run" in error["message"]
    assert "content/graders/doubling/checks.py" in error["message"]
    assert "--yes" in error["help"]
    assert [run["kind"] for run in course("grade", "log", "out", "--json").json["runs"]] == ["run"]
    done = course(*words, "--yes")
    assert done.code in {0, 6}
    assert ran
    assert "eve began the run" in done.err


@pytest.mark.parametrize("words", WAYS.values(), ids=WAYS)
def test_a_person_at_a_terminal_is_asked(course, ran, words, monkeypatch):
    asked = []
    monkeypatch.setattr(Console, "interactive", property(lambda self: True))
    monkeypatch.setattr(Console, "confirm", lambda _, question: asked.append(question) or len(asked) > 1)
    for times, agreed in ((1, False), (2, True)):
        done = course(*words)
        assert len(asked) == times
        assert "eve began the run" in done.out
        assert (done.code in {0, 6}, bool(ran)) == (agreed, agreed)
        assert agreed or "Nothing was run" in done.err


@pytest.mark.parametrize("words", WAYS.values(), ids=WAYS)
def test_nobody_is_asked_about_graders_that_are_here_too_or_began_a_run_here(
    course, ran, words, tmp_path, monkeypatch
):
    monkeypatch.setenv("COURSE_CACHE", str(tmp_path / "elsewhere"))
    assert course(*words).code in {0, 6}  # edited since, but this checkout began the run
    monkeypatch.setenv("COURSE_CACHE", str(tmp_path / "empty"))
    checks = tmp_path / "content" / "graders" / "doubling" / "checks.py"
    checks.write_text(checks.read_text().removesuffix("# theirs were others\n"))
    assert course(*words).code in {0, 6}  # nothing is known of it, but it is this checkout's to the letter


def test_a_file_more_in_the_gradebooks_graders_makes_them_somebody_elses(course, ran, tmp_path):
    checks = tmp_path / "content" / "graders" / "doubling" / "checks.py"
    checks.write_text(checks.read_text().removesuffix("# theirs were others\n"))
    (tmp_path / "content" / "graders" / "doubling" / "late.py").write_text("")
    assert course(*WAYS["rerun"]).code == 0  # what is here and not there does not run
    shutil.rmtree(tmp_path / "content" / "solutions")
    assert course(*WAYS["rerun"]).code == 2
