"""Where a student is: what was done and learned, the next step, and what this machine can do."""

import importlib.metadata
import itertools
import re
import shutil
from pathlib import Path
from types import SimpleNamespace

import pytest

from course.catalog.load import Catalog
from course.cli.frame.console import Console
from course.cli.frame.here import load_catalog
from course.cli.setup import doctor
from course.progress.quiz import DONE, START
from course.progress.store import Store
from course.reading.parts import read_script
from course.reading.record import InProgress, Place
from tests.unit.cli.conftest import Said, record


@pytest.fixture
def step(course):
    """What `course next` names."""

    def named():
        return course("next --quiet").out.strip()

    return named


def test_exercises_and_lessons_are_called_by_number_too(course, workspace):
    assert course("start 1 --json").json["exercise"] == "doubling", "its place among them"
    assert course("start 2 --json").json["exercise"] == "halving"
    assert course("lesson 2 --json").json["id"] == "half-as-much"
    for words in (("start", "3"), ("start", "0"), ("lesson", "3"), ("lesson", "0"), ("lesson", "9" * 5000)):
        assert course(*words).code == 5
    assert "Did you mean halving" in course("start halvin").err


def test_an_exercise_whose_folder_is_gone_is_started_again_wherever_a_step_is_named(course, workspace, write):
    write("wrong", "wrong")
    course("check doubling")
    shutil.rmtree(workspace / "doubling")
    course("hint").refuses(3, "`course start doubling` puts one there")
    shutil.rmtree(workspace / ".course" / "given")
    for words in ((), ("next",), ("progress",)):
        assert "course start doubling" in course(*words).out
    for words in (("check",), ("diff",), ("report", "doubling")):
        course(*words).refuses(3, "`course start doubling` puts one there")
    assert course("reset doubling -y").out == "doubling/doubling.py is the stub again.\n"
    assert "course check doubling" in course("next").out


def test_a_number_that_meant_another_exercise_names_both(course, workspace):
    assert "before 2.0" not in course("start 1").err, "nothing was begun when numbers meant others"
    course("start halving")
    assert "before 2.0" not in course("check 1").err, "whoever begins now knows no other number"
    record(workspace).append("start", "halving", {"version": "1.2.0"})
    said = course("check 1").err
    assert "1 is doubling, by the order of the lessons; before 2.0 it was halving, which is 2 now." in said
    assert "before 2.0" not in course("start 2").err, "the chapter has no 2"
    assert "before 2.0" not in course("start doubling").err


def test_warm_ups_are_called_by_number_too(course, real):
    warm_ups = course("warmup --json").json["warm_ups"]
    assert [one["number"] for one in warm_ups] == list(range(1, len(warm_ups) + 1))
    assert f"4. {warm_ups[3]['title']}" in course("warmup").out
    assert course("warmup 4 --json").json["exercise"] == warm_ups[3]["id"]
    assert course("warmup", str(len(warm_ups) + 1)).code == 5


def test_exercises_lists_numbers_lessons_and_states(course, workspace, write):
    write("RIGHT", "RIGHT")
    course("check doubling")
    body = course("exercises --json").json
    assert [(one["id"], one["number"], one["chapter"], one["state"]) for one in body["exercises"]] == [
        ("doubling", 1, None, "complete"),
        ("halving", 2, 1, "new"),
    ]
    assert body["next"]["command"] == "course start halving"
    course("exercises").says(
        "1: doubling: Doubling; lesson twice-as-much; ours, not the chapter's; every public check passes 4/4"
    )


def test_exercises_outside_of_a_workspace(course):
    body = course("exercises --json").json
    assert body["workspace"] is None
    assert len(body["exercises"]) == 2


def test_next_names_the_step_that_the_dashboard_names(course, workspace):
    for _ in range(2):
        step = course("next --json").json["next"]["command"]
        assert step == course("--json").json["next"]["command"] == course("go --json").json["next"]["command"]
        record(workspace).append("lesson", "twice-as-much")
    assert course("next --quiet").out == "course check doubling\n"


def test_the_dashboard_says_where_the_next_exercise_comes(course, real):
    course().says(
        "Exercise 1, integrators, comes after lesson 3. To start it now: course start integrators\n"
    )
    said = course("start integrators").out
    assert re.search(r"It takes \d minutes to read; you can begin after the first function's section\.", said)
    course("warmup first-program")
    started = "integrators: started, not checked yet. To go on: course check integrators\n"
    course().says(started).lacks("comes after lesson")
    course("check integrators")
    course("warmup first-program")
    going = r"integrators: in progress, 0 of \d+ points. To go on: course check integrators\n"
    assert re.search(going, course().out)


def test_a_lesson_that_was_read_names_the_step_that_the_dashboard_names(
    course, workspace, person, monkeypatch
):
    monkeypatch.setattr(Console, "ask", lambda *_: "")  # who presses Enter
    ran = course("lesson twice-as-much --page")
    step = course("next --json").json["next"]["command"]
    assert ran.out.endswith(f"Next: {step}\n")
    assert step == "course check doubling", "it was started"


def test_a_lesson_that_was_printed_names_no_exercise_that_is_done(course, workspace, write):
    def named():
        return course("lesson twice-as-much --json").json["next"]["command"]

    assert named() == "course check doubling"
    write("RIGHT", "RIGHT")
    course("check doubling")
    assert named() == course("next --quiet").out.strip() == "course start halving"


def test_the_reader_on_the_whole_screen_and_page_by_page_go_on_where_the_other_was_left(
    course, workspace, person, monkeypatch
):
    def reader():
        store = record(workspace)
        script = read_script(Catalog().lesson("twice-as-much"))
        return InProgress(script, store.events(subject="twice-as-much"), store.append)

    typed = ["q", *itertools.repeat("", 20)]
    monkeypatch.setattr(Console, "ask", lambda *_: typed.pop(0))
    course("lesson twice-as-much --page")
    second = reader().place
    assert second.block > 0
    reader().at(Place(), second.block)  # back to the top, on the whole screen
    assert "Going on" not in course("lesson twice-as-much --page").out
    reader().at(Place(second.block + 1), second.block + 1)
    assert "Going on with page 2" in course("lesson twice-as-much --page").out
    assert "Going on" not in course("lesson twice-as-much --page").out, "it was read to its end"


def test_exercises_are_numbered_in_the_lessons_order_and_know_the_chapters_numbers():
    catalog = Catalog()
    chapter = ("engine-comparison", "integrators", "sim-to-real", "digital-twin", "validation")
    assert [catalog.exercise(name).number for name in chapter] == [1, 2, 3, 4, 5]
    for tasks in (catalog.exercises(), catalog.warm_ups(), catalog.every_task()):
        places = [catalog.lesson_ids().index(one.lesson) for one in tasks]
        assert places == sorted(places)
    places = [catalog.place_of(one) for one in catalog.exercises()]
    assert places == list(range(1, len(places) + 1))
    assert catalog.exercise_called("1").id == "integrators"


def test_the_dashboard_shows_the_evidence_for_each_objective(course, real):
    before = course("--json").json["objectives"]
    assert not any(one["lessons_read"] or one["predictions"] or one["answered"] for one in before)
    assert "right" not in course().out, "nothing of a quiz that was not taken"
    store = record(real)
    store.append("lesson", "engines")
    for text in ("", "ODE", "ODE again"):  # a skip, and one key twice
        store.append("prediction", "engines", {"key": f"k{bool(text)}", "number": 1, "text": text})
    right = {"which-engine": True, "why-simulate": False}
    store.append(START, "", {"attempt": "a", "seed": 1, "version": "1", "questions": list(right)})
    unfinished = course("--json").json["objectives"]
    assert not any(one["answered"] for one in unfinished)
    store.append(DONE, "", {"attempt": "a", "right": right, "score": 1, "passed": False, "total": 2})
    after = course("--json").json["objectives"]
    changed = [
        (a["lessons_read"], a["predictions"], a["answered"])
        for a, b in zip(after, before, strict=True)
        if a != b
    ]
    assert changed == [(["engines"], 1, ["which-engine"])]
    catalog = Catalog()
    place = catalog.place_of(catalog.exercise("engine-comparison"))
    course().says(
        f"exercise {place}, engine-comparison: not started", "quiz: 1 of 1 right", "quiz: 0 of 1 right"
    )


def test_next_offers_the_warm_ups_of_the_lesson_just_read_and_then_its_exercise(course, real, step):
    store, catalog = record(real), Catalog()

    for lesson in ("why-simulate", "how-an-engine-works", "numerical-integration"):
        store.append("lesson", lesson)
    warm_ups = [one.id for one in catalog.warm_ups("numerical-integration")]
    for name in warm_ups:
        assert step() == f"course warmup {name}"
        store.append("check", name, passing())
    assert step() == "course start integrators"
    done = next(one for one in course("--json").json["objectives"] if "integrators" in one["exercises"])
    assert (done["warm_ups_done"], done["warm_ups"]) == (len(warm_ups), len(warm_ups))
    course("start integrators")
    assert step() == "course check integrators"


def test_next_begins_with_a_task_and_goes_on_from_what_was_done_last(real, step):
    store, every = record(real), Catalog().every_task()

    assert step() == f"course warmup {every[0].id}", "no lesson stands before it"
    store.append("start", every[5].id)
    assert step() == f"course warmup {every[5].id}", "where the student went"
    store.append("check", every[5].id, passing())
    assert step() == f"course warmup {every[6].id}"
    store.append("check", every[0].id, passing() | {"all": True})
    assert step() == f"course warmup {every[6].id}", "a check of all is about none"
    for task in every[6:]:
        store.append("check", task.id, passing())
    assert step() == "course quiz take", "warm-ups that were left out are left behind"


def test_an_exercise_that_was_left_out_comes_at_the_end(real, step):
    store, every = record(real), Catalog().every_task()
    for task in every:
        if task.id != "collisions":
            store.append("check", task.id, passing())
    assert step() == "course start collisions"


def test_a_warm_up_that_was_begun_is_checked_and_moving_on_leaves_it_behind(course, real, step):
    record(real).append("lesson", "why-simulate")
    (first, *_) = Catalog().warm_ups("why-simulate")
    assert course("warmup", first.id).code == 0
    assert step() == f"course check {first.id}"
    record(real).append("lesson", "how-an-engine-works")
    assert first.id not in step()


def passing():
    """What is kept of a check in which everything passed."""
    return {
        "state": "graded", "only": "", "score": 1.0, "max_score": 1.0, "passed": True, "all_pass": True,
        "seconds": 0.1, "fingerprint": "x", "checks": [],
    }  # fmt: skip


ASKED = "## Once\n\n> **Predict.** What is twice five?\n\n> **Answer.** Ten.\n"


@pytest.fixture
def question(course, workspace, content):
    """A prediction that a lesson of the mini course asks for."""
    lesson = content / "lessons" / "twice-as-much.md"
    lesson.write_text(lesson.read_text().replace("## Once\n", ASKED))
    (asked,) = read_script(load_catalog().lesson("twice-as-much")).questions
    return asked


def say(workspace, question, **data):
    record(workspace).append("prediction", "twice-as-much", {"key": question.key, "number": 1, **data})


def test_a_wrong_prediction_is_shown_with_its_section_to_read_again(course, workspace, question):
    say(workspace, question, text="eleven")
    say(workspace, question, judged="wrong")
    body = course("progress --json").json
    (said,) = body["predictions"]["each"]
    assert (said["said"], said["judged"], said["section"]) == ("eleven", "wrong", "twice-as-much#once")
    assert "twice five" in said["question"]
    assert body["predictions"]["by_lesson"][0]["wrong"] == 1
    (place,) = body["revisit"]
    assert (place["section"], place["title"]) == ("twice-as-much#once", "Once")
    course("progress --plain").says(
        "Predictions: 1 made, 0 skipped\n  twice-as-much: 1 wrong\n",
        "  Once (a wrong prediction)\n    course lesson twice-as-much#once\n",
    )
    opened = course(*place["command"].split()[1:], "--plain").out
    assert opened.lstrip().startswith("Section: Once\n")
    assert "Ten." in opened
    assert course("lesson twice-as-much --plain").out.count("Section: ") > opened.count("Section: ")


def test_a_right_prediction_sends_nobody_back_and_a_question_that_is_asked_no_more_still_counts(
    course, workspace, question
):
    say(workspace, question, text="ten")
    say(workspace, question, judged="right")
    say(workspace, SimpleNamespace(key="gone"), text="x")
    body = course("progress --json").json
    assert body["predictions"]["all"]["right"] == 1
    assert body["revisit"] == []
    (said,) = [one for one in body["predictions"]["each"] if one["said"] == "x"]
    assert (said["question"], said["section"], said["judged"]) == ("", "", None)


def test_a_mistake_is_seen_then_mended_and_its_section_goes_with_it(course, workspace, write):
    write("wrong", "RIGHT")
    course("check")
    body = course("progress --json").json
    (mistake,) = body["mistakes"]
    assert (mistake["diagnosis"], mistake["task"], mistake["mended_at"]) == ("NOT_RIGHT", "double", None)
    assert mistake["read"] == "twice-as-much#once"
    assert body["revisit"][0]["why"] == ["double in doubling: NOT_RIGHT"]
    # A diagnosis that has no words is not shown as a code.
    course("progress --plain").says("(doubling: double)\n", "Mistakes: 1 made, 0 fixed\n", "Not right.")
    write("RIGHT", "RIGHT")
    course("check")
    body = course("progress --json").json
    assert body["mistakes"][0]["mended_at"] > mistake["last_seen"]
    assert body["revisit"] == []
    course("progress --plain").says("Mistakes: 1 made, 1 fixed\n")


def test_a_mistake_that_its_check_names_no_more_is_not_called_unfixed_and_sends_nobody_to_read(
    course, workspace
):
    store = record(workspace)
    for diagnosis in ("NOT_RIGHT", None):
        check = {"id": "a", "task": "double", "status": "fail", "diagnosis": diagnosis}
        store.append("check", "doubling", {"state": "graded", "checks": [check]})
        body, shown = course("progress --json").json, course("progress --plain").out
        assert body["mistakes"][0]["named"] == bool(diagnosis) == bool(body["revisit"])
        assert (", not fixed yet, " if diagnosis else ", not named any more, ") in shown


def test_an_exception_is_named_among_the_mistakes(course, workspace):
    store = record(workspace)
    check = {"id": "a", "task": "double", "status": "error", "diagnosis": "RAISED"}
    for more in ({}, {"raised": "NameError: name 'v1v2' is not defined"}):
        store.append("check", "doubling", {"state": "graded", "checks": [check | more]})
        words = course("progress --json").json["mistakes"][0]["looks_like"]
        assert words == f"Raised {more.get('raised', 'an exception')}."


def test_who_did_nothing_yet_reads_nothing_about_it(course, workspace):
    course("progress --plain").lacks("Predictions", "Mistakes", "To read again")


def test_a_section_that_is_not_there_is_refused_with_those_that_are(course, workspace):
    course("lesson 'twice-as-much#twice'").refuses(5, "has no section 'twice'", "once")


def test_lesson_without_an_id_goes_on_to_the_next_unread_one(course, workspace):
    assert course("lesson --json").json["id"] == "twice-as-much"
    record(workspace).append("lesson", "twice-as-much")
    assert course("lesson --json").json["id"] == "half-as-much"
    lessons = course("lessons --json").json["lessons"]
    assert [lesson["read_at"] is not None for lesson in lessons] == [True, False]


def test_a_print_is_no_reading_and_needs_no_workspace(course, workspace, monkeypatch):
    for shape in ("--json", "--plain", "--page"):
        assert course("lesson twice-as-much", shape).code == 0
    assert not any(lesson["read_at"] for lesson in course("lessons --json").json["lessons"])
    monkeypatch.chdir(workspace.parent)
    assert "the number added to itself" in course("lesson twice-as-much --plain").out


def test_progress_has_dates_and_scores(course, workspace, write):
    course("lesson")
    write("wrong", "RIGHT")
    course("check")
    course("hint")
    write("RIGHT", "RIGHT")
    course("check")
    course("submit")
    body = course("progress --json").json
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
    assert course("doctor --repair").code == 0
    assert (workspace / ".course" / "progress.damaged.sqlite").read_bytes().startswith(b"not a database")
    assert Store(record).events() == ()


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="has no device that is always full")
@pytest.mark.usefixtures("unprobed")
def test_doctor_finds_a_full_disk_by_writing_to_it(course, workspace, monkeypatch):
    def full(**where):
        assert where == {"dir": str(workspace), "buffering": 0}
        return Path("/dev/full").open("wb", buffering=0)

    monkeypatch.setattr(doctor.tempfile, "TemporaryFile", full)
    said = "cannot be written (No space left on device); checks run"
    course("doctor").ends(4, said, "Something is missing.")


def test_doctor_never_advises_switching_a_protection_off(course):
    words = Said(course("doctor").out.lower()).says("protection")
    words.lacks("disable", "switch off", "turn off", "sysctl", "setenforce 0", "--privileged")


@pytest.mark.usefixtures("unprobed")
def test_doctor_names_the_command_for_what_is_missing(course, monkeypatch):
    real = importlib.metadata.version

    def version(name):
        if name == "pymunk":
            raise importlib.metadata.PackageNotFoundError(name)
        return "0.1" if name == "rich" else real(name)

    monkeypatch.setattr(importlib.metadata, "version", version)
    monkeypatch.setattr("course.extras._lines", lambda: ["pymunk>=7.0", "rich>=14", "numpy"])
    ran = course("doctor --json").ends(4)
    assert ran.json["fixes"][0]["command"] == "pip install 'pymunk>=7.0' 'rich>=14'"


@pytest.mark.usefixtures("unprobed")
def test_a_missing_extra_is_offered_and_is_no_failure_nor_is_one_that_cannot_be_had(course, monkeypatch):
    wanted = [
        "numpy", "no-such-engine>=4; extra == 'engines'", "no-such-linter; extra == 'dev'",
        "pybullet>=3.2.7; python_version < '3.0' and extra == 'bullet'",
    ]  # fmt: skip
    monkeypatch.setattr("course.extras._lines", lambda: wanted)
    ran = course("doctor --json").ends(0)
    assert [fix["command"] for fix in ran.json["fixes"]] == ["pip install 'no-such-engine>=4'"]
    assert {package["group"] for package in ran.json["packages"]} == {"", "engines"}
    (sentence,) = ran.json["unserved"]
    assert sentence.startswith("Optional (bullet): pybullet has no wheel for Python 3.")
    assert sentence in ran.err
