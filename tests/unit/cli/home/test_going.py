"""Numbers instead of ids, the list of exercises, objectives with their evidence, and the one loop."""

import itertools
import re
import shutil

import pytest

from course.catalog.load import Catalog
from course.cli.frame.console import Console
from course.progress.quiz import DONE, START
from course.reading.parts import read_script
from course.reading.record import InProgress, Place
from tests.unit.cli.conftest import record


@pytest.fixture
def real(course, tmp_path, monkeypatch):
    """A workspace of the real course; the current folder."""
    monkeypatch.delenv("COURSE_CONTENT")
    assert course("init", ".").code == 0
    return tmp_path


@pytest.fixture
def step(course):
    """What `course next` names."""

    def named():
        return course("next", "--quiet").out.strip()

    return named


def test_exercises_and_lessons_are_called_by_number_too(course, workspace):
    assert course("start", "1", "--json").json["exercise"] == "doubling", "its place among them"
    assert course("start", "2", "--json").json["exercise"] == "halving"
    assert course("lesson", "2", "--json").json["id"] == "half-as-much"
    for words in (("start", "3"), ("start", "0"), ("lesson", "3"), ("lesson", "0"), ("lesson", "9" * 5000)):
        assert course(*words).code == 5
    assert "Did you mean halving" in course("start", "halvin").err


def test_an_exercise_whose_folder_is_gone_is_started_again_wherever_a_step_is_named(course, workspace, write):
    write("wrong", "wrong")
    course("check", "doubling")
    shutil.rmtree(workspace / "doubling")
    hint = course("hint")
    assert (hint.code, "`course start doubling` puts one there" in hint.err) == (3, True)
    shutil.rmtree(workspace / ".course" / "given")
    for words in ((), ("next",), ("progress",)):
        assert "course start doubling" in course(*words).out
    for words in (("check",), ("diff",), ("report", "doubling")):
        ran = course(*words)
        assert (ran.code, "`course start doubling` puts one there" in ran.err) == (3, True)
    assert course("reset", "doubling", "-y").out == "doubling/doubling.py is the stub again.\n"
    assert "course check doubling" in course("next").out


def test_a_number_that_meant_another_exercise_names_both(course, workspace):
    assert "before 2.0" not in course("start", "1").err, "nothing was begun when numbers meant others"
    course("start", "halving")
    assert "before 2.0" not in course("check", "1").err, "whoever begins now knows no other number"
    record(workspace).append("start", "halving", {"version": "1.2.0"})
    said = course("check", "1").err
    assert "1 is doubling, by the order of the lessons; before 2.0 it was halving, which is 2 now." in said
    assert "before 2.0" not in course("start", "2").err, "the chapter has no 2"
    assert "before 2.0" not in course("start", "doubling").err


def test_warm_ups_are_called_by_number_too(course, real):
    warm_ups = course("warmup", "--json").json["warm_ups"]
    assert [one["number"] for one in warm_ups] == list(range(1, len(warm_ups) + 1))
    assert f"4. {warm_ups[3]['title']}" in course("warmup").out
    assert course("warmup", "4", "--json").json["exercise"] == warm_ups[3]["id"]
    assert course("warmup", str(len(warm_ups) + 1)).code == 5


def test_exercises_lists_numbers_lessons_and_states(course, workspace, write):
    write("RIGHT", "RIGHT")
    course("check", "doubling")
    body = course("exercises", "--json").json
    assert [(one["id"], one["number"], one["chapter"], one["state"]) for one in body["exercises"]] == [
        ("doubling", 1, None, "complete"),
        ("halving", 2, 1, "new"),
    ]
    assert body["next"]["command"] == "course start halving"
    assert (
        "1: doubling: Doubling; lesson twice-as-much; ours, not the chapter's; every public check passes 4/4"
        in course("exercises").out
    )


def test_exercises_outside_of_a_workspace(course):
    body = course("exercises", "--json").json
    assert body["workspace"] is None
    assert len(body["exercises"]) == 2


def test_next_names_the_step_that_the_dashboard_names(course, workspace):
    for _ in range(2):
        step = course("next", "--json").json["next"]["command"]
        assert (
            step == course("--json").json["next"]["command"] == course("go", "--json").json["next"]["command"]
        )
        record(workspace).append("lesson", "twice-as-much")
    assert course("next", "--quiet").out == "course check doubling\n"


@pytest.fixture
def someone(monkeypatch):
    """A person who presses Enter; what they were asked."""
    asked = []
    monkeypatch.setattr(Console, "interactive", property(lambda _: True))
    monkeypatch.setattr(Console, "go_on", lambda _, question: not asked.append(question))
    monkeypatch.setattr(Console, "ask", lambda *_: "")
    return asked


def test_the_dashboard_says_where_the_next_exercise_comes(course, real):
    ahead = "Exercise 1, integrators, comes after lesson 3. To start it now: course start integrators\n"
    assert ahead in course().out
    said = course("start", "integrators").out
    assert re.search(r"It takes \d minutes to read; you can begin after the first function's section\.", said)
    course("warmup", "first-program")
    said = course().out
    assert "integrators: started, not checked yet. To go on: course check integrators\n" in said
    assert "comes after lesson" not in said
    course("check", "integrators")
    course("warmup", "first-program")
    going = r"integrators: in progress, 0 of \d+ points. To go on: course check integrators\n"
    assert re.search(going, course().out)


def test_a_lesson_that_was_read_names_the_step_that_the_dashboard_names(course, workspace, someone):
    ran = course("lesson", "twice-as-much", "--page")
    step = course("next", "--json").json["next"]["command"]
    assert ran.out.endswith(f"Next: {step}\n")
    assert step == "course check doubling", "it was started"


def test_a_lesson_that_was_printed_names_no_exercise_that_is_done(course, workspace, write):
    def named():
        return course("lesson", "twice-as-much", "--json").json["next"]["command"]

    assert named() == "course check doubling"
    write("RIGHT", "RIGHT")
    course("check", "doubling")
    assert named() == course("next", "--quiet").out.strip() == "course start halving"


def test_the_reader_on_the_whole_screen_and_page_by_page_go_on_where_the_other_was_left(
    course, workspace, monkeypatch
):
    def reader():
        store = record(workspace)
        script = read_script(Catalog().lesson("twice-as-much"))
        return InProgress(script, store.events(subject="twice-as-much"), store.append)

    monkeypatch.setattr(Console, "interactive", property(lambda _: True))
    typed = ["q", *itertools.repeat("", 20)]
    monkeypatch.setattr(Console, "ask", lambda *_: typed.pop(0))
    course("lesson", "twice-as-much", "--page")
    second = reader().place
    assert second.block > 0
    reader().at(Place(), second.block)  # back to the top, on the whole screen
    assert "Going on" not in course("lesson", "twice-as-much", "--page").out
    reader().at(Place(second.block + 1), second.block + 1)
    assert "Going on with page 2" in course("lesson", "twice-as-much", "--page").out
    assert "Going on" not in course("lesson", "twice-as-much", "--page").out, "it was read to its end"


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
    shown = course().out
    assert f"exercise {place}, engine-comparison: not started" in shown
    assert "quiz: 1 of 1 right" in shown
    assert "quiz: 0 of 1 right" in shown


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
    course("start", "integrators")
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
