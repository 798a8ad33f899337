"""Warm-ups on the command line: listed by lesson, started, checked, counted; never among the exercises."""

import shutil
import zipfile

import pytest

from course.catalog.load import Catalog
from course.cli.frame.here import Here
from course.cli.home.advice import after_report
from course.grading.intake.downloads import class_list
from course.grading.intake.students import read_student
from tests.unit.cli.conftest import MINI_COURSE, record


@pytest.fixture
def warm(course, workspace, content):
    """The command line on a mini course with two warm-ups, in a workspace."""
    for order, name in enumerate(("adding", "taking"), 1):
        add(content / "exercises" / "warm-ups" / name, name, order)
    return course


def add(folder, name, order):
    folder.mkdir(parents=True)
    (folder / "exercise.toml").write_text(
        f'format_version = 1\nkind = "warm-up"\nid = "{name}"\ntitle = "One thing {name}"\n'
        f'module = "{name}.py"\nlesson = "twice-as-much"\norder = {order}\nminutes = 5\nsummary = "Short."\n'
        '[[task]]\nid = "first"\ntitle = "The first"\npoints = 1\nhints = ["Think.", "Write RIGHT."]\n'
        '[[task]]\nid = "second"\ntitle = "The second"\npoints = 1\nhints = ["Think.", "Write RIGHT."]\n'
    )
    (folder / "README.md").write_text(f"# {name}\n\n`first(x)` gives one thing, `second(x)` another.\n")
    (folder / f"{name}.py").write_text(
        '"""Two."""\n\n\ndef first(x):\n    return x\n\n\ndef second(x):\n    return x\n'
    )
    (folder / "checks.py").write_text("")


def write(workspace, name, first, second):
    text = f"def first(x):\n    return {first!r}\n\n\ndef second(x):\n    return {second!r}\n"
    (workspace / "warm-ups" / name / f"{name}.py").write_text(text)


def test_what_is_next_calls_it_a_small_task(warm, tmp_path, monkeypatch):
    warm("init", str(tmp_path / "fresh"))
    monkeypatch.chdir(tmp_path / "fresh")
    record(tmp_path / "fresh").append("lesson", "twice-as-much")
    assert warm("next --json").json["next"]["command"] == "course warmup adding"
    warm("warmup adding")
    body = warm("next --json").json
    assert body["next"]["command"] == "course check adding"
    assert body["why"] == "the small task where you left off"


def test_all_are_listed_by_lesson_with_what_is_done(warm, workspace):
    body = warm("warmup --json").json
    assert [(one["id"], one["state"]) for one in body["warm_ups"]] == [("adding", "new"), ("taking", "new")]
    assert body["next"]["command"] == "course warmup adding"
    for lesson, theirs in (("twice-as-much", body["warm_ups"]), ("half-as-much", [])):
        assert warm("warmup", lesson, "--json").json["warm_ups"] == theirs
    warm("warmup adding")
    write(workspace, "adding", "RIGHT", "RIGHT")
    warm("check adding")
    warm("warmup").ends(0, "1 of 2 done", "done: 1. One thing adding (adding), 5 min")
    assert warm("warmup --json").json["next"]["command"] == "course warmup taking"


def test_one_is_started_with_its_text_and_lies_with_the_others(warm, workspace):
    assert "first(x) gives one thing" in warm("warmup adding").out
    assert (workspace / "warm-ups" / "adding" / "adding.py").is_file()
    assert (workspace / "warm-ups" / "adding" / "README.md").is_file()
    assert warm("warmup adding --json").json["files"][0]["action"] == "kept"


def test_it_is_checked_as_an_exercise_is_and_without_points(warm, workspace):
    warm("start adding")
    write(workspace, "adding", "RIGHT", "wrong")
    warm("warmup adding --check").ends(1, "1 of 2 checks passes.").lacks("points", "score")
    assert warm("check warm-ups/adding/adding.py --json").json["exercise"] == "adding"
    write(workspace, "adding", "RIGHT", "RIGHT")
    done = warm("check adding")
    assert "this warm-up is done" in done.out
    assert "course warmup taking" in done.err + done.out


def test_one_thing_at_a_time_is_told_and_a_hint_is_due_after_an_attempt(warm, workspace):
    warm("start adding")
    write(workspace, "adding", "wrong", "also wrong")
    said = warm("check adding")
    assert said.out.count("Write RIGHT.") == 1
    assert "--verbose shows all" in said.out + said.err
    warm("warmup adding --check --verbose").says("Your code printed:")
    warm("warmup adding --verbose").warns("--verbose goes with --check.")
    assert warm("hint adding --json").json["hint"] == "Think."


def test_progress_counts_them_and_check_all_leaves_them_alone(warm, workspace):
    warm("start adding")
    write(workspace, "adding", "RIGHT", "RIGHT")
    warm("check adding")
    body = warm("progress --json").json
    assert [one["state"] for one in body["warm_ups"]] == ["done", "new"]
    assert [one["id"] for one in body["exercises"]] == ["doubling", "halving"]
    assert "1 of 2 done" in warm("progress").out
    warm("start doubling")
    assert [one["exercise"] for one in warm("check --all --json").json["results"]] == ["doubling"]


def test_an_exercise_is_no_warm_up_and_a_course_without_them_does_not_speak_of_them(warm, monkeypatch):
    assert warm("warmup doubling --json").json["error"]["code"] == "not_a_warm_up"
    assert "`course warmup` lists" in warm("warmup nowhere").err
    monkeypatch.setenv("COURSE_CONTENT", str(MINI_COURSE))
    assert "arm-up" not in warm("progress").out
    assert "no warm-ups" in warm("warmup").out


def test_check_reset_update_and_diff_know_where_it_lies(warm, workspace, monkeypatch):
    warm("start taking")
    warm("start adding")
    write(workspace, "adding", "mine", "mine")
    assert "def first" in warm("diff adding").out
    assert warm("reset adding --yes").code == 0
    assert "return x" in (workspace / "warm-ups/adding/adding.py").read_text()
    changed = {change["path"] for change in warm("update --json").json["changes"]}
    assert str(workspace / "warm-ups/adding/adding.py") in changed
    monkeypatch.chdir(workspace / "warm-ups" / "taking")
    assert warm("check --json").json["exercise"] == "taking", "the folder one is in says which"


def test_they_are_handed_in_only_when_asked_for(warm, workspace, tmp_path_factory):
    warm("start adding")
    warm("start doubling")
    write(workspace, "adding", "RIGHT", "RIGHT")
    (workspace / "doubling" / "doubling.py").write_text("def double(x):\n    return 'RIGHT'\n")
    folder = tmp_path_factory.mktemp("class")
    for student, more in (("ada", ["--warm-ups"]), ("bob", [])):
        (folder / student).mkdir()
        assert warm("submit -o", folder / student / "mine.zip", *more).code == 0
    inside = [set(zipfile.ZipFile(folder / name / "mine.zip").namelist()) for name in ("ada", "bob")]
    assert "warm-ups/adding/adding.py" in inside[0]
    assert inside[0] - inside[1] == {"warm-ups/adding/adding.py"}
    loose = folder / "cem" / "warm-ups" / "adding"
    loose.mkdir(parents=True)
    shutil.copy(workspace / "warm-ups/adding/adding.py", loose)
    asked = [Catalog().exercise("adding")]
    entries = [read_student(one, asked, required=True) for one in class_list(folder).students]
    found = {entry.student: entry.submission is not None for (entry,) in entries}
    assert found == {"ada": True, "bob": False, "cem": True}


def test_what_follows_a_report_is_no_check_that_sends_back_to_it(warm, workspace):
    """And after a warm-up comes the next one, also of a lesson that is half read."""
    store = record(workspace)
    store.append("bookmark", "twice-as-much", {"block": 1, "part": 0.0, "words": ""})

    def step():
        here = Here.load()
        return after_report(here, here.catalog.exercise("adding"))

    warm("start adding")
    write(workspace, "adding", "RIGHT", "wrong")
    warm("check adding")
    assert step() == "course check adding"
    write(workspace, "adding", "RIGHT", "RIGHT")
    assert warm("check adding --json").json["next"]["command"] == step() == "course warmup taking"


def test_a_fault_of_a_program_that_was_given_is_nobody_s_mistake_and_another_is(warm, workspace, content):
    declared = content / "exercises" / "warm-ups" / "adding" / "exercise.toml"
    declared.write_text(declared.read_text().replace("points = 1\n", 'points = 1\nfault = "NOT_RIGHT"\n', 1))
    warm("start adding")
    write(workspace, "adding", "wrong", "RIGHT")
    warm("check adding")
    given = "Faults in the programs you were given: 1 found by a check"
    warm("progress").says(f"{given}, 0 fixed").lacks("Mistakes")
    write(workspace, "adding", "RIGHT", "wrong")
    warm("check adding")
    warm("progress").says(f"{given}, 1 fixed", "Mistakes: 1 made, 0 fixed")
    assert [one["given"] for one in warm("progress --json").json["mistakes"]] == [True, False]


@pytest.mark.parametrize("words", [(), ("--plain",), ("--json",)])
def test_a_printed_lesson_names_each_warm_up_once_with_its_command(warm, words):
    said = warm("lesson twice-as-much", *words)
    text = said.json["text"] if "--json" in words else said.out
    assert [text.count(f"course warmup {name}") for name in ("adding", "taking")] == [1, 1]
    assert "Warm-up, 5 minutes: One thing adding" in text
