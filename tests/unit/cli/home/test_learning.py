"""What was done and learned, what there is to read, and what this machine can do."""

import shutil
from pathlib import Path
from types import SimpleNamespace

import pytest

from course.cli.frame.here import load_catalog
from course.cli.setup import doctor
from course.progress.store import Store
from course.reading.parts import read_script
from tests.unit.cli.conftest import MINI_COURSE, record

ASKED = "## Once\n\n> **Predict.** What is twice five?\n\n> **Answer.** Ten.\n"


@pytest.fixture
def asking(course, workspace, monkeypatch, tmp_path_factory):
    """The command line on a mini course with a prediction, in a workspace; and the question."""
    folder = tmp_path_factory.mktemp("content") / "mini"
    shutil.copytree(MINI_COURSE, folder)
    lesson = folder / "lessons" / "twice-as-much.md"
    lesson.write_text(lesson.read_text().replace("## Once\n", ASKED))
    monkeypatch.setenv("COURSE_CONTENT", str(folder))
    (question,) = read_script(load_catalog().lesson("twice-as-much")).questions
    return course, question


def say(workspace, question, **data):
    record(workspace).append("prediction", "twice-as-much", {"key": question.key, "number": 1, **data})


def test_a_wrong_prediction_is_shown_with_its_section_to_read_again(asking, workspace):
    course, question = asking
    say(workspace, question, text="eleven")
    say(workspace, question, judged="wrong")
    body = course("progress", "--json").json
    (said,) = body["predictions"]["each"]
    assert (said["said"], said["judged"], said["section"]) == ("eleven", "wrong", "twice-as-much#once")
    assert "twice five" in said["question"]
    assert body["predictions"]["by_lesson"][0]["wrong"] == 1
    (place,) = body["revisit"]
    assert (place["section"], place["title"]) == ("twice-as-much#once", "Once")
    shown = course("progress", "--plain").out
    assert "Predictions: 1 made, 0 skipped\n  twice-as-much: 1 wrong\n" in shown
    assert "  Once (a wrong prediction)\n    course lesson twice-as-much#once\n" in shown
    opened = course(*place["command"].split()[1:], "--plain").out
    assert opened.lstrip().startswith("Section: Once\n")
    assert "Ten." in opened
    assert course("lesson", "twice-as-much", "--plain").out.count("Section: ") > opened.count("Section: ")


def test_a_right_prediction_sends_nobody_back_and_a_question_that_is_asked_no_more_still_counts(
    asking, workspace
):
    course, question = asking
    say(workspace, question, text="ten")
    say(workspace, question, judged="right")
    say(workspace, SimpleNamespace(key="gone"), text="x")
    body = course("progress", "--json").json
    assert body["predictions"]["all"]["right"] == 1
    assert body["revisit"] == []
    (said,) = [one for one in body["predictions"]["each"] if one["said"] == "x"]
    assert (said["question"], said["section"], said["judged"]) == ("", "", None)


def test_a_mistake_is_seen_then_mended_and_its_section_goes_with_it(course, workspace, write):
    write("wrong", "RIGHT")
    course("check")
    body = course("progress", "--json").json
    (mistake,) = body["mistakes"]
    assert (mistake["diagnosis"], mistake["task"], mistake["mended_at"]) == ("NOT_RIGHT", "double", None)
    assert mistake["read"] == "twice-as-much#once"
    assert body["revisit"][0]["why"] == ["double in doubling: NOT_RIGHT"]
    shown = course("progress", "--plain").out
    assert "(doubling: double)\n" in shown
    assert "Mistakes: 1 made, 0 fixed\n" in shown
    assert "Not right." in shown, "a diagnosis that has no words is not shown as a code"
    write("RIGHT", "RIGHT")
    course("check")
    body = course("progress", "--json").json
    assert body["mistakes"][0]["mended_at"] > mistake["last_seen"]
    assert body["revisit"] == []
    assert "Mistakes: 1 made, 1 fixed\n" in course("progress", "--plain").out


def test_a_mistake_that_its_check_names_no_more_is_not_called_unfixed_and_sends_nobody_to_read(
    course, workspace
):
    store = record(workspace)
    for diagnosis in ("NOT_RIGHT", None):
        check = {"id": "a", "task": "double", "status": "fail", "diagnosis": diagnosis}
        store.append("check", "doubling", {"state": "graded", "checks": [check]})
        body, shown = course("progress", "--json").json, course("progress", "--plain").out
        assert body["mistakes"][0]["named"] == bool(diagnosis) == bool(body["revisit"])
        assert (", not fixed yet, " if diagnosis else ", not named any more, ") in shown


def test_an_exception_is_named_among_the_mistakes(course, workspace):
    store = record(workspace)
    check = {"id": "a", "task": "double", "status": "error", "diagnosis": "RAISED"}
    for more in ({}, {"raised": "NameError: name 'v1v2' is not defined"}):
        store.append("check", "doubling", {"state": "graded", "checks": [check | more]})
        words = course("progress", "--json").json["mistakes"][0]["looks_like"]
        assert words == f"Raised {more.get('raised', 'an exception')}."


def test_who_did_nothing_yet_reads_nothing_about_it(course, workspace):
    shown = course("progress", "--plain").out
    assert not any(word in shown for word in ("Predictions", "Mistakes", "To read again"))


def test_a_section_that_is_not_there_is_refused_with_those_that_are(course, workspace):
    course("lesson", "twice-as-much#twice").refuses(5, "has no section 'twice'", "once")


def test_lesson_without_an_id_goes_on_to_the_next_unread_one(course, workspace):
    assert course("lesson", "--json").json["id"] == "twice-as-much"
    record(workspace).append("lesson", "twice-as-much")
    assert course("lesson", "--json").json["id"] == "half-as-much"
    lessons = course("lessons", "--json").json["lessons"]
    assert [lesson["read_at"] is not None for lesson in lessons] == [True, False]


def test_a_print_is_no_reading_and_needs_no_workspace(course, workspace, monkeypatch):
    for shape in ("--json", "--plain", "--page"):
        assert course("lesson", "twice-as-much", shape).code == 0
    assert not any(lesson["read_at"] for lesson in course("lessons", "--json").json["lessons"])
    monkeypatch.chdir(workspace.parent)
    assert "the number added to itself" in course("lesson", "twice-as-much", "--plain").out


def test_progress_has_dates_and_scores(course, workspace, write):
    course("lesson")
    write("wrong", "RIGHT")
    course("check")
    course("hint")
    write("RIGHT", "RIGHT")
    course("check")
    course("submit")
    body = course("progress", "--json").json
    doubling = body["exercises"][0]
    told = [doubling[key] for key in ("state", "score", "checks_run", "hints_shown")]
    assert told == ["complete", 4.0, 2, 1]
    assert doubling["passed_at"]
    assert len(body["submissions"]) == 1
    assert "score 4/4" in course("progress").out


@pytest.fixture
def unprobed(monkeypatch):
    """A machine whose protection is known: to try it takes longer than the rest."""
    monkeypatch.setattr(doctor, "protection", lambda: ("L3", (), ()))


@pytest.mark.usefixtures("unprobed")
def test_doctor_repairs_a_damaged_record_and_keeps_it(course, workspace):
    record = workspace / ".course" / "progress.sqlite"
    record.write_bytes(b"not a database, not at all, no" * 10)
    course("doctor").ends(4, "progress.sqlite")
    assert course("doctor", "--repair").code == 0
    assert (workspace / ".course" / "progress.damaged.sqlite").read_bytes().startswith(b"not a database")
    assert Store(record).events() == ()


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="has no device that is always full")
@pytest.mark.usefixtures("unprobed")
def test_doctor_finds_a_full_disk_by_writing_to_it(course, workspace, monkeypatch):
    def full(**where):
        assert where == {"dir": str(workspace), "buffering": 0}
        return Path("/dev/full").open("wb", buffering=0)

    monkeypatch.setattr(doctor.tempfile, "TemporaryFile", full)
    course("doctor").ends(
        4, "cannot be written (No space left on device); checks run", "Something is missing."
    )


def test_doctor_never_advises_switching_a_protection_off(course):
    words = course("doctor").out.lower()
    assert "protection" in words
    for phrase in ("disable", "switch off", "turn off", "sysctl", "setenforce 0", "--privileged"):
        assert phrase not in words


@pytest.mark.usefixtures("unprobed")
def test_doctor_names_the_command_for_what_is_missing(course, monkeypatch):
    import importlib.metadata

    real = importlib.metadata.version

    def version(name):
        if name == "pymunk":
            raise importlib.metadata.PackageNotFoundError(name)
        return "0.1" if name == "rich" else real(name)

    monkeypatch.setattr(importlib.metadata, "version", version)
    monkeypatch.setattr("course.extras._lines", lambda: ["pymunk>=7.0", "rich>=14", "numpy"])
    ran = course("doctor", "--json")
    assert ran.code == 4
    assert ran.json["fixes"][0]["command"] == "pip install 'pymunk>=7.0' 'rich>=14'"


@pytest.mark.usefixtures("unprobed")
def test_a_missing_extra_is_offered_and_is_no_failure_nor_is_one_that_cannot_be_had(course, monkeypatch):
    wanted = [
        "numpy", "no-such-engine>=4; extra == 'engines'", "no-such-linter; extra == 'dev'",
        "pybullet>=3.2.7; python_version < '3.0' and extra == 'bullet'",
    ]  # fmt: skip
    monkeypatch.setattr("course.extras._lines", lambda: wanted)
    ran = course("doctor", "--json")
    assert ran.code == 0
    assert [fix["command"] for fix in ran.json["fixes"]] == ["pip install 'no-such-engine>=4'"]
    assert {package["group"] for package in ran.json["packages"]} == {"", "engines"}
    (sentence,) = ran.json["unserved"]
    assert sentence.startswith("Optional (bullet): pybullet has no wheel for Python 3.")
    assert sentence in ran.err
