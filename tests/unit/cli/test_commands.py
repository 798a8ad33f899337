"""Every command a student has: what it says, what it leaves alone, how it ends."""

from __future__ import annotations

import hashlib
import json
import zipfile

import pytest

from course.progress.store import Store


def _all_files(root):
    return {path: path.read_bytes() for path in root.rglob("*") if path.is_file()}


# -- where am I ------------------------------------------------------------------------------------


def test_the_dashboard_outside_of_a_workspace_says_how_to_begin(course):
    ran = course()
    assert ran.code == 0
    assert "course init" in ran.out


def test_the_dashboard_names_the_next_step(course, workspace, write):
    course("lesson", "twice-as-much")
    assert "Next: course check doubling" in course().out
    write("RIGHT", "RIGHT")
    course("check")
    ran = course()
    assert "every public check passes" in ran.out
    assert "Next: course lesson half-as-much" in ran.out


def test_the_dashboard_survives_a_damaged_record(course, workspace):
    (workspace / ".course" / "progress.sqlite").write_bytes(b"not a database, not at all, no" * 10)
    ran = course()
    assert ran.code == 0
    assert "progress.sqlite" in ran.err
    assert "Next: course doctor" in ran.out


# -- init and start --------------------------------------------------------------------------------


def test_init_twice_changes_nothing_and_says_so(course, workspace):
    before = _all_files(workspace)
    ran = course("init")
    assert ran.code == 0
    assert "already" in ran.out
    assert _all_files(workspace) == before


def test_init_inside_a_workspace_is_refused(course, workspace):
    ran = course("init", "inner", "--json")
    assert (ran.code, ran.json["error"]["code"]) == (2, "nested_workspace")
    assert not (workspace / "inner").exists()


def test_init_leaves_a_damaged_course_toml_alone(course, workspace):
    (workspace / "course.toml").write_text("[[[")
    ran = course("init")
    assert ran.code == 2
    assert "course.toml:1" in ran.err
    assert (workspace / "course.toml").read_text() == "[[["


def test_init_where_a_file_is_in_the_way_says_so(course, tmp_path):
    (tmp_path / "file").write_text("x")
    assert course("init", "file").code == 2
    assert (tmp_path / "file").read_text() == "x"


def test_start_never_overwrites(course, workspace, write):
    path = write("mine")
    before = path.read_bytes()
    ran = course("start", "doubling")
    assert ran.code == 0
    assert "left as it is" in ran.out
    assert path.read_bytes() == before


def test_start_brings_back_what_was_removed(course, workspace):
    (workspace / "doubling" / "doubling.py").unlink()
    assert course("start", "doubling/").code == 0
    assert (workspace / "doubling" / "doubling.py").is_file()


def test_an_unknown_exercise_is_not_found_and_a_close_one_is_offered(course, workspace):
    ran = course("start", "doublin", "--json")
    assert (ran.code, ran.json["error"]["code"]) == (5, "exercise_not_found")
    assert "doubling" in ran.json["error"]["help"]


@pytest.mark.parametrize(
    "command", ["start doubling", "check", "hint", "diff", "submit", "progress", "watch", "update"]
)
def test_outside_of_a_workspace_a_command_says_how_to_make_one(course, command):
    ran = course(*command.split())
    assert ran.code == 5
    assert "course init" in ran.err


# -- check -----------------------------------------------------------------------------------------


def test_check_says_message_then_advice_then_numbers(course, write):
    write("wrong", "RIGHT")
    ran = course("check")
    assert ran.code == 1
    order = [
        "It is not right.",
        "Write RIGHT.",
        "measured: 1 m",
        "expected: 1.00000001 m, within",
        "closed form",
    ]
    places = [ran.out.index(text) for text in order]
    assert places == sorted(places)
    assert "1 of 2 public checks passes; 2 hidden checks run when you submit." in ran.out
    assert "Score 2/4; the pass mark, 2.8 (70%), is not reached yet." in ran.out
    assert "Next: course hint doubling" in ran.out
    assert "\x1b" not in ran.out


def test_check_of_everything_right_says_what_is_still_to_come(course, write):
    write("RIGHT", "RIGHT")
    ran = course("check", "doubling")
    assert ran.code == 0
    assert "All 2 public checks pass; 2 hidden checks run when you submit." in ran.out
    assert "Next: course submit" in ran.out


def test_check_shows_what_the_code_printed_only_on_request(course, write):
    write("wrong", "RIGHT")
    assert "printed" not in course("check").out.replace("what your code printed", "")
    shown = course("check", "--verbose").out
    assert "\\x1b[31mprinted" in shown


def test_check_json_is_the_contract(course, write):
    write("NAN", "RIGHT")
    ran = course("check", "--json")
    body = ran.json
    assert list(body)[:3] == ["schema", "ok", "exit_code"]
    assert body["schema"] == "course.check/1"
    assert (body["ok"], body["exit_code"], body["passed"]) == (False, 1, False)
    assert body["course"] == {"id": "mini", "version": "0.1.0"}
    assert (body["exercise"], body["scope"], body["score"], body["max_score"]) == (
        "doubling",
        "public",
        2.0,
        4.0,
    )
    assert body["next"] == {"command": "course hint doubling"}
    assert body["warnings"] == []
    first = body["checks"][0]
    keys = (
        "id title task status visibility points max_points input expected actual units tolerance "
        "first_divergence diagnosis message help blocked_by duration_ms"
    )
    assert set(keys.split()) <= set(first)
    assert first["actual"] == "nan"
    assert first["tolerance"] == {"rel": 1e-9, "source": "closed form"}
    assert "It is not right." in ran.err


def test_a_pass_with_a_failing_check_exits_1_and_says_passed(course, write, students_content):
    declared = students_content / "exercises" / "doubling" / "exercise.toml"
    declared.write_text("pass_mark = 0.5\n" + declared.read_text())
    write("RIGHT", "wrong")
    body = course("check", "--json").json
    assert (body["ok"], body["exit_code"], body["passed"]) == (False, 1, True)


def test_an_ungradable_file_exits_3_in_the_envelope(course, write):
    write(extra="UNREADABLE")
    ran = course("check", "--json")
    assert ran.code == 3
    assert ran.json == {
        "schema": "course.check/1",
        "ok": False,
        "exit_code": 3,
        "error": {"code": "syntax_error", "message": "Line 1 cannot be read.", "help": "Look at line 1."},
    }


def test_a_fault_of_the_grader_exits_70(course, write):
    write(extra="FAULT")
    assert course("check").code == 70


def test_a_missing_file_exits_3_and_says_how_to_get_it_back(course, workspace):
    (workspace / "doubling" / "doubling.py").unlink()
    ran = course("check", "doubling")
    assert ran.code == 3
    assert "course start doubling" in ran.err


def test_a_file_that_is_far_too_large_is_not_read(course, workspace):
    (workspace / "doubling" / "doubling.py").write_bytes(b"#" * 1_000_001)
    ran = course("check", "--json")
    assert (ran.code, ran.json["error"]["code"]) == (3, "too_large")


def test_check_all_takes_every_started_exercise_and_the_worst_exit_code(course, workspace, write):
    course("start", "halving")
    write("RIGHT", "RIGHT")
    (workspace / "halving" / "halving.py").write_text("UNREADABLE")
    body = course("check", "--all", "--json").json
    assert (body["schema"], body["exit_code"]) == ("course.check-all/1", 3)
    assert [(r["schema"], r["exit_code"]) for r in body["results"]] == [
        ("course.check/1", 0),
        ("course.check/1", 3),
    ]


def test_check_only_runs_one_and_offers_close_names(course, write):
    write("RIGHT", "wrong")
    body = course("check", "--only", "double_works", "--json").json
    assert [check["id"] for check in body["checks"]] == ["double_works"]
    ran = course("check", "--only", "double_work")
    assert ran.code == 5
    assert "double_works" in ran.err


def test_check_without_a_name_takes_the_folder_then_the_last_one_worked_on(course, workspace, monkeypatch):
    course("start", "halving")
    assert course("check", "--json").json["exercise"] == "halving"
    course("check", "doubling")
    assert course("check", "--json").json["exercise"] == "doubling"
    course("check", "--all")
    assert course("check", "--json").json["exercise"] == "doubling"
    monkeypatch.chdir(workspace / "halving")
    assert course("check", "--json").json["exercise"] == "halving"


def test_check_works_and_says_so_where_nothing_can_be_recorded(course, workspace, write, monkeypatch):
    (workspace / ".course" / "progress.sqlite").write_bytes(b"not a database, not at all, no" * 10)
    write("RIGHT", "RIGHT")
    ran = course("check", "doubling")
    assert ran.code == 0
    assert "not recorded" in ran.err
    assert "progress.sqlite" in ran.err


def test_quiet_leaves_the_summary(course, write):
    write("wrong", "RIGHT")
    lines = course("check", "-q").out.splitlines()
    assert [line.split()[0] for line in lines] == ["1", "Score"]


# -- hint and solution -----------------------------------------------------------------------------


def test_hints_come_one_per_attempt_and_are_never_counted(course, write):
    write("wrong", "wrong")
    assert "Check your work first" in course("hint").out
    course("check")
    first = course("hint", "--json").json
    assert first["given"]
    assert first["task"] == "double"
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


def test_an_untouched_stub_earns_no_hint(course, workspace):
    course("check", "doubling")
    ran = course("hint", "doubling")
    assert ran.code == 0
    assert "follows an attempt" in ran.out


def test_a_comment_is_no_attempt(course, write):
    write("wrong", "wrong")
    course("check")
    course("hint")
    write("wrong", "wrong", extra="# thinking\n")
    course("check")
    assert course("hint", "--json").json["reason"] == "unchanged"


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


def test_no_solution_before_a_pass(course, write):
    write("wrong", "RIGHT")
    course("check")
    ran = course("solution", "--json")
    assert (ran.code, ran.json["error"]["code"]) == (5, "not_passed")


def test_a_checkout_shows_its_solution_after_a_pass(course, write):
    write("RIGHT", "RIGHT")
    course("check")
    ran = course("solution", "--json")
    assert ran.code == 0
    assert "def double" in ran.json["files"]["doubling.py"]


def test_a_student_without_a_pack_is_told_where_one_comes_from(course, write, students_content):
    write("RIGHT", "RIGHT")
    course("check")
    ran = course("solution")
    assert ran.code == 5
    assert ".coursepack" in ran.err


def test_a_pack_in_the_workspace_is_opened(course, workspace, write, students_content):
    from course.catalog.pack import pack_bytes

    write("RIGHT", "RIGHT")
    course("check")
    (workspace / "week 1.coursepack").write_bytes(
        pack_bytes("mini", "1.0.0", {"doubling": {"doubling.py": b"def double(x):\n    return x + x\n"}})
    )
    body = course("solution", "--json").json
    assert body["files"] == {"doubling.py": "def double(x):\n    return x + x\n"}
    assert body["source"].endswith("week 1.coursepack")


def test_a_damaged_pack_is_an_integrity_error(course, workspace, write, students_content):
    write("RIGHT", "RIGHT")
    course("check")
    (workspace / "a.coursepack").write_bytes(b"no zip")
    assert course("solution").code == 7


# -- diff, reset, update ---------------------------------------------------------------------------


def test_diff_of_an_untouched_file_says_so(course, workspace):
    ran = course("diff")
    assert ran.code == 0
    assert "as it was handed out" in ran.out


def test_diff_shows_lines_added_and_removed(course, write):
    write("RIGHT", "wrong")
    body = course("diff", "--json").json
    assert body["changed"]
    assert "+    'RIGHT'" in body["diff"]
    assert body["added"] == sum(row.startswith("+") for row in body["diff"].splitlines()[2:])


def test_reset_asks_nobody_and_needs_yes(course, write):
    path = write("mine")
    before = path.read_bytes()
    ran = course("reset", "doubling", "--json")
    assert (ran.code, ran.json["error"]["code"]) == (2, "needs_yes")
    assert path.read_bytes() == before


def test_reset_keeps_a_copy_and_prints_its_path(course, workspace, write):
    path = write("mine")
    before = path.read_bytes()
    body = course("reset", "doubling", "--yes", "--json").json
    copy = workspace / body["backups"][0]["backup"]
    assert copy.read_bytes() == before
    assert "NotImplementedError" in path.read_text()
    assert "nothing was changed" in course("reset", "doubling").out


def test_reset_writes_nothing_if_the_copy_cannot_be_made(course, workspace, write):
    path = write("mine")
    before = path.read_bytes()
    (workspace / ".course" / "backups").write_text("a file where a folder should be")
    ran = course("reset", "doubling", "--yes")
    assert ran.code == 4
    assert path.read_bytes() == before


@pytest.fixture
def newer_content(students_content):
    """The same course, one version later: another README and another stub for doubling."""
    syllabus = students_content / "lessons" / "syllabus.toml"
    text = syllabus.read_text()
    lines = [line for line in text.splitlines() if not line.startswith("version")]
    syllabus.write_text("\n".join([lines[0], 'version = "9.0.0"', *lines[1:]]) + "\n")
    folder = students_content / "exercises" / "doubling"
    for name in ("README.md", "doubling.py"):
        (folder / name).write_text((folder / name).read_text() + "\n# newer\n")
    return students_content


def test_update_replaces_what_was_not_edited_and_puts_the_rest_beside(
    course, workspace, write, newer_content
):
    mine = write("mine").read_bytes()
    folder = workspace / "doubling"
    old_readme = (folder / "README.md").read_bytes()
    before = _all_files(workspace)
    dry = course("update", "--dry-run", "--json").json
    assert _all_files(workspace) == before
    body = course("update", "--json").json
    assert (
        [c["action"] for c in body["changes"]]
        == [c["action"] for c in dry["changes"]]
        == ["replace", "beside"]
    )
    assert (body["to_version"], dry["dry_run"]) == ("9.0.0", True)
    assert (folder / "README.md").read_text().endswith("# newer\n")
    assert (workspace / body["changes"][0]["backup"]).read_bytes() == old_readme
    assert (folder / "doubling.py").read_bytes() == mine
    assert (folder / "doubling.py.new").read_text().endswith("# newer\n")
    assert 'version = "9.0.0"' in (workspace / "course.toml").read_text()


def test_a_second_update_has_nothing_to_do(course, workspace, write, newer_content):
    write("mine")
    course("update")
    before = {p: d for p, d in _all_files(workspace).items() if p.suffix != ".sqlite"}
    ran = course("update")
    assert "as new as the course" in ran.out
    assert {p: d for p, d in _all_files(workspace).items() if p.suffix != ".sqlite"} == before


def test_update_keeps_an_earlier_new_file(course, workspace, write, newer_content):
    write("mine")
    beside = workspace / "doubling" / "doubling.py.new"
    beside.write_text("my notes")
    body = course("update", "--json").json
    assert (workspace / body["changes"][1]["backup"]).read_text() == "my notes"


def test_update_leaves_a_removed_file_removed(course, workspace, newer_content):
    (workspace / "doubling" / "doubling.py").unlink()
    assert course("update", "--json").json["changes"][1]["action"] == "missing"
    assert not (workspace / "doubling" / "doubling.py").exists()


# -- submit ----------------------------------------------------------------------------------------


def test_submit_writes_one_zip_with_checksums(course, workspace, write):
    source = write("RIGHT", "wrong").read_bytes()
    course("check")
    ran = course("submit")
    assert ran.code == 0
    assert "doubling/doubling.py" in ran.out
    assert "score 2/4 at the last check" in ran.out
    with zipfile.ZipFile(workspace / "mini-submission.zip") as archive:
        assert archive.namelist() == ["doubling/doubling.py", "submission.json"]
        assert archive.read("doubling/doubling.py") == source
        manifest = json.loads(archive.read("submission.json"))
    assert manifest["format_version"] == 1
    assert manifest["course"]["id"] == "mini"
    assert manifest["files"] == {"doubling/doubling.py": hashlib.sha256(source).hexdigest()}
    assert manifest["quiz"] == []


def test_the_same_files_give_the_same_bytes(course, workspace, write):
    write("RIGHT", "wrong")
    course("submit", "-o", "one.zip")
    course("submit", "-o", "two.zip")
    assert (workspace / "one.zip").read_bytes() == (workspace / "two.zip").read_bytes()


def test_submit_keeps_what_it_replaces(course, workspace, write):
    write("RIGHT", "wrong")
    (workspace / "mine.zip").write_bytes(b"something else")
    body = course("submit", "-o", "mine.zip", "--json").json
    assert (workspace / body["backup"]).read_bytes() == b"something else"
    assert course("submit", "-o", "mine.zip", "--json").json["backup"] is None


def test_submit_leaves_an_untouched_stub_out(course, workspace, write):
    course("start", "halving")
    write("RIGHT", "wrong")
    body = course("submit", "--json").json
    assert [f["path"] for f in body["files"]] == ["doubling/doubling.py"]
    assert body["left_out"] == [{"path": "halving/halving.py", "action": "still the stub"}]


def test_submit_with_nothing_written_writes_nothing(course, workspace):
    ran = course("submit", "--json")
    assert (ran.code, ran.json["error"]["code"]) == (3, "nothing_to_submit")
    assert not list(workspace.glob("*.zip"))


def test_submit_warns_about_a_file_that_does_not_parse(course, workspace):
    (workspace / "doubling" / "doubling.py").write_text("def double(x:\n")
    body = course("submit", "--json").json
    assert "line 1" in body["warnings"][0]


@pytest.mark.parametrize("output", ["nowhere/mine.zip", "doubling/doubling.py"])
def test_submit_refuses_an_output_that_makes_no_sense(course, workspace, write, output):
    source = write("RIGHT", "wrong").read_bytes()
    assert course("submit", "-o", output).code == 2
    assert (workspace / "doubling" / "doubling.py").read_bytes() == source


# -- lessons and progress --------------------------------------------------------------------------


def test_lesson_without_an_id_goes_on_to_the_next_unread_one(course, workspace):
    assert course("lesson", "--json").json["id"] == "twice-as-much"
    assert course("lesson", "--json").json["id"] == "half-as-much"
    assert [lesson["read_at"] is not None for lesson in course("lessons", "--json").json["lessons"]] == [
        True,
        True,
    ]


def test_a_lesson_can_be_read_outside_of_a_workspace(course):
    ran = course("lesson", "twice-as-much", "--plain")
    assert ran.code == 0
    assert "the number added to itself" in ran.out


def test_an_unknown_lesson_is_not_found(course):
    ran = course("lesson", "twice", "--json")
    assert (ran.code, ran.json["error"]["code"]) == (5, "lesson_not_found")


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
    assert (doubling["state"], doubling["score"], doubling["checks_run"], doubling["hints_shown"]) == (
        "complete",
        4.0,
        2,
        1,
    )
    assert doubling["passed_at"]
    assert len(body["submissions"]) == 1
    assert "score 4/4" in course("progress").out


# -- doctor ----------------------------------------------------------------------------------------


def test_doctor_repairs_a_damaged_record_and_keeps_it(course, workspace):
    record = workspace / ".course" / "progress.sqlite"
    record.write_bytes(b"not a database, not at all, no" * 10)
    damaged = course("doctor")
    assert damaged.code == 4
    assert "progress.sqlite" in damaged.out
    ran = course("doctor", "--repair")
    assert ran.code == 0
    assert (workspace / ".course" / "progress.damaged.sqlite").read_bytes().startswith(b"not a database")
    assert Store(record).events() == ()


def test_doctor_never_advises_switching_a_protection_off(course):
    words = course("doctor").out.lower()
    assert "protection" in words
    for phrase in ("disable", "switch off", "turn off", "sysctl", "setenforce 0", "--privileged"):
        assert phrase not in words


def test_doctor_names_the_command_for_what_is_missing(course, monkeypatch):
    import importlib.metadata

    real = importlib.metadata.version

    def version(name):
        if name == "pymunk":
            raise importlib.metadata.PackageNotFoundError(name)
        return "0.1" if name == "rich" else real(name)

    monkeypatch.setattr(importlib.metadata, "version", version)
    monkeypatch.setattr("course.cli.doctor._requirements", lambda root: ["pymunk>=7.0", "rich>=14", "numpy"])
    ran = course("doctor", "--json")
    assert ran.code == 4
    assert ran.json["fixes"][0]["command"] == "pip install 'pymunk>=7.0' 'rich>=14'"
