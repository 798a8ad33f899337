"""Help, as much as has been worked for."""

from __future__ import annotations

import json

from course.catalog.pack import pack_bytes


def test_hints_come_one_per_attempt_and_are_never_counted(course, write):
    write("wrong", "wrong")
    assert "Check your work first" in course("hint").out
    course("check")
    first = course("hint", "--json").json
    assert first["given"]
    assert first["task"] == "double"
    for extra in ("", "# thinking\n"):  # a comment is no attempt
        write("wrong", "wrong", extra)
        course("check")
        again = course("hint", "--json").json
        assert (again["given"], again["reason"], again["hint"]) == (False, "unchanged", first["hint"])
    write("wrong # a comment does count inside a string", "wrong")
    course("check")
    second = course("hint", "--json").json
    assert second["given"]
    assert second["hint"] != first["hint"]
    for reply in (first, again, second):
        words = json.dumps(reply)
        assert "left" not in words
        assert " of 3" not in words


def test_a_hint_fits_what_the_check_thinks_is_wrong(course, write, students_content):
    hints = students_content / "exercises" / "doubling" / "exercise.toml"
    hints.write_text(hints.read_text().replace("SQUARES_INSTEAD", "NOT_RIGHT"))
    write("wrong", "RIGHT")
    course("check")
    assert course("hint", "--json").json["hint"] == "Try your function on a negative number too."
    # The same mistake again: what fits has been said, so the mildest that is left comes next.
    write("wrong again", "RIGHT")
    course("check")
    assert course("hint", "--json").json["hint"] == "What is a number added to itself?"
    assert course("hint", "--json").json["hint"] == "What is a number added to itself?"


def test_a_hint_goes_on_with_the_students_numbers_where_the_check_has_them(course, write, students_content):
    hints = students_content / "exercises" / "doubling" / "exercise.toml"
    sentences = (
        '1 = ["At {x} it is {got}."]\n2 = ["At {x} it is {got}.", "At h = {h} it is {got}, not {expected}."]'
    )
    hints.write_text(hints.read_text().replace("[task.fits]", f"[task.yours]\n{sentences}\n\n[task.fits]"))
    write("wrong", "RIGHT")
    course("check")
    assert course("hint", "--json").json["hint"] == "What is a number added to itself?"
    write("wrong again", "RIGHT")
    course("check")
    told = "Try your function on a negative number too. At h = 0.05 it is 1, not 1.00000001."
    assert course("hint", "--json").json["hint"] == told
    again = course("hint", "--json").json
    assert (again["reason"], again["hint"]) == ("unchanged", told)


def test_before_its_start_an_exercise_has_no_hint_and_starting_it_is_next(course, workspace):
    assert course("hint", "halving", "--json").json["next"]["command"] == "course start halving"
    course("start", "halving")
    assert course("hint", "halving", "--json").json["next"]["command"] == "course check halving"


def test_an_untouched_stub_earns_no_hint(course, workspace):
    course("check", "doubling")
    ran = course("hint", "doubling")
    assert ran.code == 0
    assert "follows an attempt" in ran.out


def test_a_function_that_is_not_begun_has_no_hint_and_another_one_that_fails_goes_first(course, write):
    write("raise NotImplementedError", "wrong")
    course("check")
    reply = course("hint", "--json").json
    assert (reply["given"], reply["task"]) == (True, "doublings")
    write("RIGHT", "raise NotImplementedError")
    assert course("check", "--json").json["next"]["command"] == "course watch doubling"
    reply = course("hint", "--json").json
    assert (reply["given"], reply["reason"], reply["hint"]) == (False, "unchanged", reply["hint"])
    assert course("hint", "--task", "double", "--json").json["reason"] == "passing"


def test_hints_go_to_the_first_failing_task_or_the_one_asked_for(course, write):
    write("RIGHT", "wrong")
    course("check")
    assert course("hint", "--json").json["task"] == "doublings"
    write("wrong", "wrong")
    course("check")
    assert course("hint", "--task", "doublings", "--json").json["task"] == "doublings"
    ran = course("hint", "--task", "halve")
    assert ran.code == 5
    assert "doublings" in ran.err


def test_hints_that_run_out_are_replaced_by_the_lesson(course, write):
    reply = {"given": True}
    for attempt in range(20):
        write(f"wrong {attempt}", "RIGHT")
        course("check")
        reply = course("hint", "--json").json
        if not reply["given"]:
            break
    assert reply["reason"] == "exhausted"
    assert "course lesson twice-as-much" in reply["message"]


def test_nothing_fails_nothing_to_hint_at(course, write):
    write("RIGHT", "RIGHT")
    course("check")
    body = course("hint", "--json").json
    assert (body["reason"], body["next"]["command"]) == ("passing", "course submit")


def test_a_file_that_could_not_run_is_sent_back_to_its_check(course, write):
    write(extra="UNREADABLE")
    course("check")
    assert course("hint", "--json").json["reason"] == "ungradable"


def test_a_checkout_shows_its_solution_after_a_pass_and_not_before(course, write):
    write("wrong", "RIGHT")
    course("check")
    ran = course("solution", "--json")
    assert (ran.code, ran.json["error"]["code"]) == (5, "not_passed")
    write("RIGHT", "RIGHT")
    course("check")
    ran = course("solution", "--json")
    assert ran.code == 0
    assert "def double" in ran.json["files"]["doubling.py"]


def test_a_pack_in_the_workspace_is_opened_and_without_one_it_is_told_where_one_comes_from(
    course, workspace, write, students_content
):
    write("RIGHT", "RIGHT")
    course("check")
    ran = course("solution")
    assert ran.code == 5
    assert ".coursepack" in ran.err
    pack, model = workspace / "week 1.coursepack", "def double(x):\n    return x + x\n"
    pack.write_bytes(pack_bytes("mini", "1.0.0", {"doubling": {"doubling.py": model.encode()}}))
    body = course("solution", "--json").json
    assert body["files"] == {"doubling.py": model}
    assert body["source"].endswith("week 1.coursepack")
    pack.write_bytes(b"no zip")
    assert course("solution").code == 7, "it is damaged"
