"""Numbers instead of ids, the list of exercises, objectives with their evidence, and the one loop."""

from __future__ import annotations

import re

import pytest

from course.catalog.load import Catalog
from course.cli.frame.console import Console
from course.progress.quiz import DONE, START
from course.progress.store import Store
from course.reading.parts import read_script
from course.reading.record import InProgress, Place


def record(workspace):
    return Store(workspace / ".course" / "progress.sqlite")


def test_exercises_and_lessons_are_called_by_number_too(course, workspace):
    assert course("start", "1", "--json").json["exercise"] == "halving", "its own number, not its place"
    assert course("lesson", "2", "--json").json["id"] == "half-as-much"
    for words in (("start", "2"), ("lesson", "3"), ("lesson", "0"), ("lesson", "9" * 5000)):
        assert course(*words).code == 5
    assert "Did you mean halving" in course("start", "halvin").err


def test_exercises_lists_numbers_lessons_and_states(course, workspace, write):
    write("RIGHT", "RIGHT")
    course("check", "doubling")
    body = course("exercises", "--json").json
    assert [(one["id"], one["number"], one["lesson"], one["state"]) for one in body["exercises"]] == [
        ("doubling", None, "twice-as-much", "complete"),
        ("halving", 1, "half-as-much", "new"),
    ]
    assert body["next"]["command"] == "course start halving"
    assert (
        "ours: doubling: Doubling; lesson twice-as-much; every public check passes 4/4"
        in course("exercises").out
    )


def test_exercises_outside_of_a_workspace(course, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
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


def test_go_outside_of_a_workspace_says_how_to_make_one(course, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    ran = course("go")
    assert ran.code == 5
    assert "course init" in ran.err


def test_go_runs_the_next_command_once_where_nobody_is_there(course, workspace):
    record(workspace).append("lesson", "twice-as-much")
    ran = course("go")
    assert ran.code == 1, "the stub fails its checks"
    assert ran.out.startswith("course check doubling")
    assert "public checks" in ran.out


@pytest.fixture
def someone(monkeypatch):
    """A person who presses Enter; what they were asked."""
    asked = []
    monkeypatch.setattr(Console, "interactive", property(lambda _: True))
    monkeypatch.setattr(Console, "go_on", lambda _, question: not asked.append(question))
    monkeypatch.setattr(Console, "ask", lambda *_: "")
    return asked


def test_a_lesson_that_was_left_by_its_key_leads_back_to_the_shell(course, workspace, someone, monkeypatch):
    ran, steps = [], iter(["course lesson twice-as-much", "course check doubling"])
    monkeypatch.setattr("course.cli.home.going.next_in_course", lambda *_: next(steps))
    monkeypatch.setattr("course.cli.home.going.again", lambda words: ran.append(words) or 0)
    monkeypatch.setattr(Console, "fills_the_screen", property(lambda _: True))
    said = course("go").out
    assert (len(ran), someone) == (1, [])
    assert said.splitlines()[-1] == "Go on at any time with: course go"


def test_go_announces_the_command_that_it_would_run(course, workspace, someone, monkeypatch):
    ran, steps = [], iter(["course lesson twice-as-much", "course check doubling"])
    monkeypatch.setattr("course.cli.home.going.next_in_course", lambda *_: next(steps))
    monkeypatch.setattr("course.cli.home.going.again", lambda words: ran.append(words) or 0)
    monkeypatch.setattr(Console, "go_on", lambda *_: False)
    said = course("go").out
    assert [words[:2] for words in ran] == [["lesson", "twice-as-much"]]
    assert "Next: course watch doubling" in said


def test_at_a_terminal_what_comes_next_is_said_once(course, workspace, someone, monkeypatch):
    steps = iter(["course lesson twice-as-much", "course check doubling"])
    monkeypatch.setattr("course.cli.home.going.next_in_course", lambda *_: next(steps))
    monkeypatch.setattr(Console, "go_on", lambda *_: False)
    said = course("go").out
    assert "Next: course watch doubling" in said
    assert said.count("Next: ") == 1, said


def test_go_and_the_dashboard_say_where_the_next_exercise_comes(course, tmp_path, monkeypatch):
    monkeypatch.delenv("COURSE_CONTENT", raising=False)
    monkeypatch.chdir(tmp_path)
    course("init", ".")
    ahead = "Exercise 2, integrators, comes after lesson 3. To start it now: course start integrators\n"
    for line in ("go", ""):
        assert ahead in course(*line.split()).out
    said = course("start", "integrators").out
    assert re.search(r"It takes \d minutes to read; you can begin after the first function's section\.", said)
    for line in ("go", ""):
        said = course(*line.split()).out
        assert "integrators: started, not checked yet. To go on: course check integrators\n" in said
        assert "comes after lesson" not in said
    course("check", "integrators")
    going = r"integrators: in progress, 0 of \d+ points. To go on: course check integrators\n"
    assert re.search(going, course("go").out)


def test_the_dashboard_says_nothing_of_a_quiz_that_was_not_taken(course, tmp_path, monkeypatch):
    monkeypatch.delenv("COURSE_CONTENT", raising=False)
    monkeypatch.chdir(tmp_path)
    course("init", ".")
    assert "of 1 right" not in course().out
    store = record(tmp_path)
    store.append(START, "", {"attempt": "a", "seed": 1, "version": "1", "questions": ["why-simulate"]})
    store.append(
        DONE, "", {"attempt": "a", "right": {"why-simulate": False}, "score": 0, "passed": False, "total": 1}
    )
    assert "quiz: 0 of 1 right" in course().out


def test_a_lesson_that_was_read_names_the_step_that_the_dashboard_names(course, workspace, someone):
    ran = course("lesson", "twice-as-much", "--page")
    step = course("next", "--json").json["next"]["command"]
    assert ran.out.endswith(f"Next: {step}\n")
    assert step == "course check doubling", "it was started"


def test_the_reader_on_the_whole_screen_and_page_by_page_go_on_where_the_other_was_left(
    course, workspace, monkeypatch
):
    def reader():
        store = record(workspace)
        script = read_script(Catalog().lesson("twice-as-much"))
        return InProgress(script, store.events(subject="twice-as-much"), store.append)

    monkeypatch.setattr(Console, "interactive", property(lambda _: True))
    typed = ["q", "", "", "", "", ""]
    monkeypatch.setattr(Console, "ask", lambda *_: typed.pop(0))
    course("lesson", "twice-as-much", "--page")
    second = reader().place
    assert second.block > 0
    reader().at(Place(), second.block)  # back to the top, on the whole screen
    assert "Going on" not in course("lesson", "twice-as-much", "--page").out
    reader().at(Place(second.block + 1), second.block + 1)
    assert "Going on with page 2" in course("lesson", "twice-as-much", "--page").out
    assert "Going on" not in course("lesson", "twice-as-much", "--page").out, "it was read to its end"


def test_go_is_one_loop_until_a_step_is_not_finished(course, workspace, write, someone, monkeypatch):
    from course.cli.home import going

    ran_with = []

    def again(words):
        ran_with.append(words)
        if words[0] == "lesson":
            record(workspace).append("lesson", words[1])
            return 0
        if words[0] == "start":
            return course_again(words)
        return 130  # a watch that was ended

    course_again = going.again
    monkeypatch.setattr(going, "again", again)
    write("RIGHT", "RIGHT")
    course("check", "doubling")
    ran = course("go")
    assert ran_with == [
        ["lesson", "half-as-much", "--page"],
        ["start", "halving"],
        ["watch", "halving"],
    ]
    assert len(someone) == 2, "asked before each further step"
    assert "Not finished yet: course check halving." in ran.out


def test_each_lesson_exercise_and_question_belongs_to_one_objective():
    catalog = Catalog()
    held = catalog.syllabus.objective
    assert sorted(x for one in held for x in one.lessons) == sorted(catalog.lesson_ids())
    assert sorted(x for one in held for x in one.exercises) == sorted(catalog.exercise_ids())
    questions = sorted(path.stem for path in catalog.content.quiz.glob("*.toml"))
    assert sorted(x for one in held for x in one.quiz) == questions
    assert len(held) == 5


def test_exercises_have_the_chapters_numbers_and_the_lessons_order():
    catalog = Catalog()
    chapter = ("engine-comparison", "integrators", "sim-to-real", "digital-twin", "validation")
    assert [catalog.exercise(name).number for name in chapter] == [1, 2, 3, 4, 5]
    places = [catalog.lesson_ids().index(one.lesson) for one in catalog.exercises()]
    assert places == sorted(places)


def test_the_dashboard_shows_the_evidence_for_each_objective(course, tmp_path, monkeypatch):
    monkeypatch.delenv("COURSE_CONTENT", raising=False)
    monkeypatch.chdir(tmp_path)
    assert course("init", ".").code == 0
    before = course("--json").json["objectives"]
    assert not any(one["lessons_read"] or one["predictions"] or one["answered"] for one in before)
    store = record(tmp_path)
    store.append("lesson", "engines")
    for text in ("", "ODE", "ODE again"):  # a skip, and one key twice
        store.append("prediction", "engines", {"key": f"k{bool(text)}", "number": 1, "text": text})
    right = {"which-engine": True, "why-simulate": False}
    store.append(START, "", {"attempt": "a", "seed": 1, "version": "1", "questions": list(right)})
    unfinished = course("--json").json["objectives"]
    assert not any(one["answered"] for one in unfinished)
    store.append(DONE, "", {"attempt": "a", "right": right, "score": 1, "passed": False})
    after = course("--json").json["objectives"]
    changed = [
        (a["lessons_read"], a["predictions"], a["answered"])
        for a, b in zip(after, before, strict=True)
        if a != b
    ]
    assert changed == [(["engines"], 1, ["which-engine"])]
    assert "exercise 1, engine-comparison: not started" in course().out


def test_next_offers_the_warm_ups_of_the_lesson_just_read_and_then_its_exercise(
    course, tmp_path, monkeypatch
):
    monkeypatch.delenv("COURSE_CONTENT", raising=False)
    monkeypatch.chdir(tmp_path)
    course("init", ".")
    store, catalog = record(tmp_path), Catalog()

    def step():
        return course("next", "--quiet").out.strip()

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


def test_a_warm_up_that_was_begun_is_checked_and_moving_on_leaves_it_behind(course, tmp_path, monkeypatch):
    monkeypatch.delenv("COURSE_CONTENT", raising=False)
    monkeypatch.chdir(tmp_path)
    course("init", ".")
    record(tmp_path).append("lesson", "why-simulate")
    (first, *_) = Catalog().warm_ups("why-simulate")
    assert course("go").out.startswith(f"course warmup {first.id}")
    assert course("next", "--quiet").out == f"course check {first.id}\n"
    record(tmp_path).append("lesson", "how-an-engine-works")
    assert first.id not in course("next", "--quiet").out


def passing():
    """What is kept of a check in which everything passed."""
    return {
        "state": "graded",
        "only": "",
        "score": 1.0,
        "max_score": 1.0,
        "passed": True,
        "all_pass": True,
        "seconds": 0.1,
        "fingerprint": "x",
        "checks": [],
    }
