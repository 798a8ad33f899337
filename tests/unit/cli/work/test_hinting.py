"""Help, as much as has been worked for; and a question in prose, answered before the answer is shown."""

import io
import json
import zipfile

import pytest

from course.catalog.load import Catalog
from course.catalog.pack import pack_bytes
from course.errors import ContentError


@pytest.fixture
def hint(course, write):
    """The hint after a check of functions with these bodies; without any, what is answered now."""

    def asked(*bodies, extra="", words=()):
        if bodies or extra:
            write(*bodies, extra=extra)
            course("check")
        return course("hint", *words, "--json").json

    return asked


@pytest.fixture
def declared(students_content):
    """What ``doubling`` says of itself, its hints among it; a test may change that."""
    return students_content / "exercises" / "doubling" / "exercise.toml"


def test_hints_come_one_per_attempt_and_are_never_counted(course, write, hint):
    write("wrong", "wrong")
    assert "Check your work first" in course("hint").out
    first = hint("wrong", "wrong")
    assert first["given"]
    assert first["task"] == "double"
    for extra in ("", "# thinking\n"):  # a comment is no attempt
        again = hint("wrong", "wrong", extra=extra)
        assert (again["given"], again["reason"], again["hint"]) == (False, "unchanged", first["hint"])
    second = hint("wrong # a comment does count inside a string", "wrong")
    assert second["given"]
    assert second["hint"] != first["hint"]
    words = json.dumps([first, again, second])
    assert not [count for count in ("left", " of 3") if count in words]


def test_a_function_that_was_tried_too_is_not_said_to_be_unwritten(hint):
    assert hint("wrong", "wrong")["task"] == "double"
    other = hint(words=("--task", "doublings"))
    assert (other["given"], other["reason"]) == (False, "unchanged")
    told = "has one hint, and this one's was about double. Ask with --task before the others."
    assert other["message"].endswith(told)


def test_a_hint_fits_what_the_check_thinks_is_wrong(hint, declared):
    declared.write_text(declared.read_text().replace("SQUARES_INSTEAD", "NOT_RIGHT"))
    assert hint("wrong", "RIGHT")["hint"] == "Try your function on a negative number too."
    # The same mistake again: what fits has been said, so the mildest that is left comes next.
    assert hint("wrong again", "RIGHT")["hint"] == hint()["hint"] == "What is a number added to itself?"


def test_a_hint_that_is_not_about_the_named_mistake_says_so(hint, declared):
    whole, _, fitting = declared.read_text().partition("SQUARES_INSTEAD")
    declared.write_text(f"{whole}NOT_RIGHT{fitting}")
    assert hint("wrong", "RIGHT")["message"] == ""
    declared.write_text(f"{whole}ANOTHER{fitting}")
    told = "No hint is about the mistake that this check named"
    assert hint("wrong again", "RIGHT")["message"].startswith(told)


def test_a_hint_goes_on_with_the_students_numbers_where_the_check_has_them(hint, declared):
    sentences = (
        '1 = ["At {x} it is {got}."]\n2 = ["At {x} it is {got}.", "At h = {h} it is {got}, not {expected}."]'
    )
    declared.write_text(
        declared.read_text().replace("[task.fits]", f"[task.yours]\n{sentences}\n\n[task.fits]")
    )
    assert hint("wrong", "RIGHT")["hint"] == "What is a number added to itself?"
    told = "Try your function on a negative number too. At h = 0.05 it is 1, not 1.00000001."
    assert hint("wrong again", "RIGHT")["hint"] == told
    again = hint()
    assert (again["reason"], again["hint"]) == ("unchanged", told)


def test_before_its_start_an_exercise_has_no_hint_and_starting_it_is_next(course, hint):
    assert hint(words=["halving"])["next"]["command"] == "course start halving"
    course("start halving")
    assert hint(words=["halving"])["next"]["command"] == "course check halving"


def test_an_untouched_stub_earns_no_hint(course, workspace):
    course("check doubling")
    course("hint doubling").ends(0, "follows an attempt")


def test_a_function_that_is_not_begun_has_no_hint_and_another_one_that_fails_goes_first(course, hint):
    reply = hint("raise NotImplementedError", "wrong")
    assert (reply["given"], reply["task"]) == (True, "doublings")
    reply = hint("RIGHT", "raise NotImplementedError")
    assert (reply["given"], reply["reason"]) == (False, "unchanged")
    assert course("check --json").json["next"]["command"] == "course watch doubling"
    assert hint(words=["--task", "double"])["reason"] == "passing"


def test_hints_go_to_the_first_failing_task_or_the_one_asked_for(course, hint):
    assert hint("RIGHT", "wrong")["task"] == "doublings"
    assert hint("wrong", "wrong", words=["--task", "doublings"])["task"] == "doublings"
    course("hint --task halve").refuses(5, "doublings")


def test_hints_that_run_out_are_replaced_by_the_lesson(hint):
    replies = [hint(f"wrong {attempt}", "RIGHT") for attempt in range(5)]
    assert [reply["given"] for reply in replies] == [True, True, True, False, False]
    assert replies[-1]["reason"] == "exhausted"
    assert "course lesson twice-as-much" in replies[-1]["message"]


@pytest.mark.parametrize(
    ("extra", "reason", "step"),
    [("", "passing", "course submit"), ("UNREADABLE", "ungradable", "course check doubling")],
    ids=["nothing fails", "a file that could not run"],
)
def test_where_there_is_nothing_to_hint_at_it_is_said_why(hint, extra, reason, step):
    body = hint("RIGHT", "RIGHT", extra=extra)
    assert (body["reason"], body["next"]["command"]) == (reason, step)


def test_a_checkout_shows_its_solution_after_a_pass_and_not_before(course, write):
    write("wrong", "RIGHT")
    course("check")
    assert course("solution --json").error == (5, "not_passed")
    write("RIGHT", "RIGHT")
    course("check")
    assert "def double" in course("solution --json").ends(0).json["files"]["doubling.py"]


def test_a_pack_in_the_workspace_is_opened_and_without_one_it_is_told_where_one_comes_from(
    course, workspace, write, students_content
):
    write("RIGHT", "RIGHT")
    course("check")
    course("solution").refuses(5, ".coursepack")
    pack, model = workspace / "week 1.coursepack", "def double(x):\n    return x + x\n"
    pack.write_bytes(pack_bytes("mini", "1.0.0", {"doubling": {"doubling.py": model.encode()}}))
    body = course("solution --json").json
    assert body["files"] == {"doubling.py": model}
    assert body["source"].endswith("week 1.coursepack")
    pack.write_bytes(b"no zip")
    assert course("solution").code == 7, "it is damaged"


RUBRIC = """format_version = 1
question = "When would you double?"
least_words = 4
points = ["It names a number.", "It says why."]
good_answer = "I double two to get four."
"""
ANSWER = "Whenever half is too little for me."


@pytest.fixture
def rubric(students_content):
    """The question of doubling, and how its answer is graded."""
    path = students_content / "exercises" / "doubling" / "rubric.toml"
    path.write_text(RUBRIC)
    return path


@pytest.fixture
def passed(course, rubric, write):
    """Doubling, which has a question, passes."""
    write("RIGHT", "RIGHT")
    course("check doubling").ends(0)


def test_the_question_comes_once_the_checks_pass_and_its_answer_once_something_was_written(
    course, rubric, write, workspace
):
    assert course("reflect doubling --json").error == (5, "not_passed_yet")
    write("RIGHT", "RIGHT")
    course("check doubling").ends(0)
    reply = course("reflect doubling --json").ends(0).json
    assert (reply["answer"], reply["good_answer"], reply["points"]) == (None, None, [])
    (workspace / "short.txt").write_text("Dunno.")
    assert course("reflect doubling --answer short.txt --json").error == (2, "too_short")
    assert course("reflect doubling --json").json["answer"] is None


def test_what_was_written_and_how_it_was_graded_is_kept(course, passed, workspace):
    (workspace / "mine.txt").write_text(ANSWER)
    course("reflect doubling --answer mine.txt").says("I double two to get four.")
    for wrong in ("yes", "yes,maybe", "yes,no,no"):
        course("reflect doubling --grades", wrong).ends(2)
    course("reflect doubling --grades 'yes, No'").ends(0)
    body = course("reflect doubling --json").json
    assert body["answer"] == ANSWER
    assert [point["grade"] for point in body["points"]] == ["yes", "no"]
    (workspace / "mine.txt").write_text(ANSWER + " And more.")
    body = course("reflect doubling --answer mine.txt --json").json
    assert [point["grade"] for point in body["points"]] == [None, None], "another answer, not graded yet"


def test_it_changes_no_score_and_is_not_handed_in(course, passed, workspace):
    before = course("progress --json").json["exercises"]
    (workspace / "mine.txt").write_text(ANSWER)
    course("reflect doubling --answer mine.txt --grades no,no")
    assert course("progress --json").json["exercises"] == before
    course("submit -o mine.zip")
    with zipfile.ZipFile(workspace / "mine.zip") as archive:
        assert not any(ANSWER.encode() in archive.read(name) for name in archive.namelist())


def test_in_a_terminal_it_is_typed_and_graded_point_by_point(course, passed, person, monkeypatch):
    monkeypatch.setattr("sys.stdin", io.StringIO(f"{ANSWER}\n\nperhaps\ny\npartly\n"))
    assert course("reflect doubling").code == 0
    body = course("reflect doubling --json").json
    assert [point["grade"] for point in body["points"]] == ["yes", "partly"]


def test_what_was_typed_is_kept_where_it_ends_too_early_and_an_early_empty_line_ends_nothing(
    course, passed, person, monkeypatch
):
    monkeypatch.setattr("sys.stdin", io.StringIO("Whenever\n\nhalf is\n"))
    course("reflect doubling").refuses(2, "3 words")
    assert course("reflect doubling --json").json["answer"] is None
    monkeypatch.setattr("sys.stdin", io.StringIO("too little.\n\ny\ny\n"))
    course("reflect doubling").ends(0, "You began:\nWhenever\n\nhalf is\nGo on from there.")
    assert course("reflect doubling --json").json["answer"] == "Whenever\n\nhalf is\ntoo little."


def test_an_exercise_without_a_question_says_which_have_one(course, rubric, workspace):
    course("reflect halving").refuses(5, "doubling")


def test_a_rubric_whose_answer_is_too_short_is_refused(rubric):
    rubric.write_text(RUBRIC.replace("least_words = 4", "least_words = 40"))
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
