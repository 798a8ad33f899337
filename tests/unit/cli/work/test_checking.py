"""``course check``: what it says, what it records, how it ends."""

import shutil

import numpy as np
import pytest

from course.figures.described import compared
from course.handed_in import attempts
from course.handed_in.limits import MAX_FILE
from tests.unit.cli.conftest import FakeSession


def test_check_says_message_then_advice_then_numbers_and_quiet_leaves_the_summary(course, write):
    write("wrong", "RIGHT")
    ran = (
        course("check")
        .ends(
            1,
            "1 of 2 public checks passes; 2 hidden checks run when it is graded.",
            "Score 2/4; a pass takes 6.3 of 9 points, hidden checks included.",
            "Next: course hint doubling",
            "Your code printed:\n      \\x1b[31mprinted\n",
        )
        .lacks("\x1b")
    )
    ran.says_in_order("It is not right.", "Write RIGHT.", "measured: 1 m", "expected: 1.00000001 m")
    assert [line.split()[0] for line in course("check -q").rows] == ["1", "Score"]


def test_check_shows_the_first_lines_that_loading_printed_and_all_on_request(course, write):
    for extra in ("'PRINTS'\n", "'PRINTS UNREADABLE'\n"):
        write("wrong", "RIGHT", extra)
        course("check").says(
            "Loading your file printed:\n  row 0\n", "  row 5\n  and 3 more lines with --verbose\n"
        ).lacks("row 6")
        assert "  row 8\n" in course("check --verbose").out
    write("wrong", "RIGHT", "'PRINTS'\n")
    assert course("check --json").json["printed"].endswith("row 8\n")


def test_what_passing_checks_printed_is_one_line_until_it_is_asked_for(course, write):
    write("RIGHT SAYS", "RIGHT SAYS")
    course("check").says("Your code printed in 2 checks that pass; --verbose shows it.").lacks("a row")
    assert course("check --verbose").out.count("    Your code printed:\n      a row\n") == 2


def test_check_says_first_what_the_last_edit_fixed_and_broke(course, write):
    write("wrong", "raise NotImplementedError")
    course("check")
    write("wrong", "RIGHT")
    course("check").lacks("fixed", "broke")  # it was not written before
    course("check").lacks("fixed", "broke")  # nothing was edited
    write("RIGHT", "wrong")
    told = "  broke: Doubled again and again  [doublings]\n  fixed: Twice a number  [double]\n"
    assert course("check").out.startswith(told)
    write("RIGHT", "RIGHT")
    assert course("check").out.startswith("  fixed: Doubled again and again  [doublings]\n")


def test_a_file_whose_name_has_other_capitals_is_told(course, write):
    path = write("RIGHT", "RIGHT")
    (path.parent / "Doubling.py").write_text("x = 1\n")
    course("check").warns("doubling/Doubling.py is not read: the file that counts is doubling.py.")
    course("submit").warns("doubling/Doubling.py is not read")
    path.unlink()
    course("check").refuses(3, "Rename Doubling.py to doubling.py")
    course("submit").says("doubling/doubling.py (not there; Doubling.py is not read under that name)")


def test_a_link_to_no_file_is_told(course, write):
    path = write("RIGHT", "RIGHT")
    path.unlink()
    path.symlink_to("/nope")
    assert "doubling.py is a link to /nope, and no file is there.\nRemove the link" in course("check").err
    assert "doubling/doubling.py (not there)" in course("submit").out


def test_one_file_under_two_spellings_is_not_told(course, write):
    """What a file system on which capitals do not count shows."""
    path = write("RIGHT", "RIGHT")
    (path.parent / "Doubling.py").hardlink_to(path)
    assert "is not read" not in course("check").err


def test_check_json_is_the_contract(course, write):
    write("NAN", "RIGHT")
    ran = course("check --json")
    body = ran.json
    assert list(body)[:3] == ["schema", "ok", "exit_code"]
    assert (body["schema"], body["exit_code"], body["passed"]) == ("course.check/1", 1, False)
    assert body["course"] == {"id": "mini", "version": "0.1.0"}
    told = [body[key] for key in ("exercise", "scope", "score", "max_score", "warnings")]
    assert told == ["doubling", "public", 2.0, 4.0, []]
    assert body["next"] == {"command": "course hint doubling"}
    first = body["checks"][0]
    keys = (
        "id title task status visibility points max_points input expected actual units tolerance "
        "first_divergence diagnosis message help blocked_by duration_ms"
    )
    assert set(keys.split()) <= set(first)
    assert first["actual"] == "nan"
    assert first["tolerance"] == {"rel": 1e-9, "source": "closed form"}
    assert "It is not right." in ran.err


def test_a_pass_with_a_failing_check_exits_1_and_only_runs_one_of_them(course, write, students_content):
    declared = students_content / "exercises" / "doubling" / "exercise.toml"
    declared.write_text("pass_mark = 0.5\n" + declared.read_text())
    write("RIGHT", "wrong")
    body = course("check --json").json
    assert (body["ok"], body["exit_code"], body["passed"]) == (False, 1, True)
    body = course("check --only double_works --json").json
    assert [check["id"] for check in body["checks"]] == ["double_works"]
    course("check --only double_work").refuses(5, "double_works")


@pytest.mark.parametrize(
    ("data", "code", "error", "help_"),
    [
        (b"UNREADABLE", 3, "syntax_error", "Look at line 1."),
        (b"FAULT", 70, "syntax_error", ""),
        (b"#" * (MAX_FILE + 1), 3, "too_large", ""),
        (None, 3, "no_file", "course start doubling"),
    ],
    ids=["unreadable", "a fault of the grader", "far too large", "not there"],
)
def test_what_cannot_be_graded_is_said_in_the_envelope(course, workspace, data, code, error, help_):
    path = workspace / "doubling" / "doubling.py"
    path.write_bytes(data or b"")
    if data is None:
        path.unlink()
    ran = course("check doubling --json")
    assert {*ran.json} == {"schema", "ok", "exit_code", "error"}
    assert (ran.json["schema"], *ran.error) == ("course.check/1", code, error)
    assert help_ in ran.json["error"]["help"]


def test_check_all_takes_every_started_exercise_and_the_worst_exit_code(course, workspace, write):
    course("start halving")
    write("RIGHT", "RIGHT")
    (workspace / "halving" / "halving.py").write_text("UNREADABLE")
    body = course("check --all --json").json
    assert (body["schema"], body["exit_code"]) == ("course.check-all/1", 3)
    assert [one["schema"] for one in body["results"]] == ["course.check/1"] * 2
    assert [one["exit_code"] for one in body["results"]] == [0, 3]


def test_check_without_a_name_takes_the_folder_then_the_last_one_worked_on(course, workspace, monkeypatch):
    course("start halving")
    assert course("check --json").json["exercise"] == "halving"
    course("check doubling")
    assert course("check --json").json["exercise"] == "doubling"
    course("check --all")
    assert course("check --json").json["exercise"] == "doubling"
    monkeypatch.chdir(workspace / "halving")
    assert course("check --json").json["exercise"] == "halving"


def test_check_works_and_says_so_where_nothing_can_be_recorded(course, workspace, write, monkeypatch):
    (workspace / ".course" / "progress.sqlite").write_bytes(b"not a database, not at all, no" * 10)
    write("RIGHT", "RIGHT")
    course("check doubling").refuses(0, "not recorded", "progress.sqlite")


@pytest.fixture
def curved(monkeypatch):
    """A session in which a check has left a curve."""

    def opened(exercise, catalog):
        session = FakeSession(exercise)
        t = np.arange(5.0)
        session.curves = {"doublings_works": compared(t, 3 * t, 2 * t, "x", "m")}
        return session

    monkeypatch.setattr(attempts, "open_session", opened)


def test_a_curve_is_said_in_words_where_nothing_can_be_drawn_and_its_numbers_are_in_the_reply(
    course, write, curved
):
    write("RIGHT", "wrong")
    said = "doublings_works: x over time. Your curve is visibly apart from what it should be at 1 s; at"
    shown = course("check").says(said).out
    course("check --plain").says(said)
    (curve,) = course("check --json").json["curves"]
    assert (curve["check"], curve["parts_at"], curve["right_is"]) == ("doublings_works", 1.0, "right")
    assert (curve["t"], curve["yours"][-1], curve["right"][-1]) == ([0.0, 1.0, 2.0, 3.0, 4.0], 12.0, 8.0)
    assert curve["description"] in shown


@pytest.mark.usefixtures("colourless")
def test_an_empty_line_parts_the_score_from_the_curve_below_it(course, write, curved):
    write("RIGHT", "wrong")
    lines = [line.strip() for line in course("check").out.splitlines()]
    said = next(at for at, line in enumerate(lines) if "doublings_works: x over time" in line)
    assert lines[said - 1] == ""
    assert "Score" in lines[said - 2]


def test_a_clone_without_the_record_has_its_exercises_by_their_files(course, workspace, write):
    write("RIGHT", "wrong")
    shutil.rmtree(workspace / ".course")
    assert course("check").code == 1
    shutil.rmtree(workspace / ".course")
    assert course("hint --json").json["next"]["command"] == "course check doubling"
    shutil.rmtree(workspace / ".course", ignore_errors=True)
    course("start halving")
    shutil.rmtree(workspace / ".course")
    assert (
        course("check --json").warns("none was worked on last: doubling, halving.").error[1]
        == "several_started"
    )


def test_advice_names_the_exercise_or_the_file_it_is_about(course, monkeypatch):
    course("init elsewhere")
    monkeypatch.chdir("elsewhere")
    none = course("check --all --json").json["error"]
    assert (none["code"], none["help"]) == ("nothing_started", "Start one: `course start doubling`.")
    other = course("check 'my notes.ipynb'")
    other.warns("`course notebook check 'my notes.ipynb'` checks this notebook")


def test_a_module_under_another_name_is_pointed_at(course, workspace, write):
    path = write("RIGHT", "RIGHT")
    path.rename(path.with_name("mine.py"))
    said = "There is mine.py beside it: if that is yours, rename it to doubling.py."
    course("check doubling").refuses(3, said)
