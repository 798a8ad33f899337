"""A verdict after every save, however the editor saves."""

import contextlib
import os
import re
import threading
import time
import tty
from types import SimpleNamespace

import pytest

from course.cli import loop
from course.cli.frame.console import Console
from course.cli.frame.here import Here
from course.cli.loop import saves
from course.errors import CourseError, NotFoundError


def _said(watcher):
    return watcher.console._out.getvalue()


def test_each_save_is_graded_once_and_a_file_that_cannot_run_is_reported(watcher, session, write):
    write("wrong", "RIGHT")
    assert watcher.look(session)
    assert not watcher.look(session)
    write(extra="UNREADABLE")
    assert watcher.look(session)
    assert "Line 1 cannot be read." in _said(watcher)
    assert watcher.last.exit_code == 3
    write("RIGHT", "RIGHT")
    assert watcher.look(session)
    assert [run.score for run in watcher.runs] == [2.0, 0.0, 4.0]
    assert watcher.last.ok


def test_a_file_put_in_the_place_of_the_old_one_is_a_save(watcher, session, write, workspace):
    path = write("wrong", "wrong")
    watcher.look(session)
    before = path.stat()
    scratch = workspace / "doubling" / "scratch"
    scratch.write_bytes(path.read_bytes().replace(b"wrong", b"RIGHT"))
    os.utime(scratch, ns=(before.st_atime_ns, before.st_mtime_ns))
    scratch.replace(path)
    assert watcher.look(session)
    assert watcher.last.ok


def test_a_file_that_goes_is_waited_for_but_there_must_be_one_to_begin_with(watcher, session, write, course):
    write("RIGHT", "RIGHT").unlink()
    assert course("watch doubling").code == 3
    assert not watcher.look(session)
    assert not watcher.look(session)
    assert _said(watcher).count("is gone") == 1
    write("RIGHT", "RIGHT")
    assert watcher.look(session)


def test_a_file_that_is_written_in_two_goes_is_graded_whole(watcher, session, write, workspace):
    path = workspace / "doubling" / "doubling.py"
    whole = write("RIGHT", "RIGHT").read_bytes()
    path.write_bytes(b"")
    late = threading.Timer(0.02, lambda: path.write_bytes(whole))
    late.start()
    assert watcher.look(session)
    late.join()
    assert watcher.last.ok
    assert len(watcher.runs) == 1


def test_a_fault_of_the_grader_ends_the_watch(watcher, session, write):
    write(extra="FAULT")
    with pytest.raises(CourseError):
        watcher.look(session)


@pytest.mark.parametrize("how", ["write", "rename", "after the folder was moved away and back"])
def test_saves_are_noticed_quickly(tmp_path, how):
    folder = tmp_path / "doubling"
    folder.mkdir()
    path = folder / "doubling.py"
    path.write_text("one")
    noticed = saves([path])
    next(noticed)
    done = []

    def save():
        time.sleep(0.2)
        if how.startswith("after"):
            folder.rename(tmp_path / "away")
            time.sleep(0.4)
            (tmp_path / "away").rename(folder)
            time.sleep(0.3)
        if how == "rename":
            scratch = folder / "other"
            scratch.write_text("two")
            scratch.replace(path)
        else:
            path.write_text("two")
        done.append(time.monotonic())

    thread = threading.Thread(target=save)
    thread.start()
    while not (path.is_file() and path.read_text() == "two"):
        next(noticed)
    seen = time.monotonic()
    thread.join()
    assert seen - done[0] < 60  # wall: twenty looks a second; a save that is missed is missed for ever
    noticed.close()


@pytest.fixture
def pressed(monkeypatch):
    """What happens in a loop, in this order: a key, or a call that is a save; at the end Ctrl-C."""

    def script(*happens):
        left = iter(happens)

        def saves(paths, keys):
            yield ""
            for one in left:
                if callable(one):
                    one()
                yield "" if callable(one) else one
            raise KeyboardInterrupt

        monkeypatch.setattr(loop, "saves", saves)
        monkeypatch.setattr(
            loop, "_keys", lambda console: contextlib.nullcontext(SimpleNamespace(leave=False))
        )

    return script


def _solve(name):
    def save():
        path = Here.load().workspace.root / name / f"{name}.py"
        path.write_text("".join(f"def {task.id}(x):\n    'RIGHT'\n\n" for task in _exercise(name).task))

    return save


def _exercise(name):
    return Here.load().catalog.exercise(name)


def test_ctrl_c_ends_a_watch_with_its_one_object(course, write, pressed):
    write("wrong", "RIGHT")
    pressed(lambda: write("RIGHT", "RIGHT"))
    body = course("watch doubling --json").ends(130).json
    assert (body["schema"], body["exercise"]) == ("course.watch/1", "doubling")
    assert [(run["exercise"], run["score"]) for run in body["runs"]] == [("doubling", 2.0), ("doubling", 4.0)]
    assert body["last"]["schema"] == "course.check/1"


def test_each_verdict_and_each_answer_to_a_key_ends_with_the_keys_and_the_file(
    course, workspace, write, pressed
):
    write("wrong", "RIGHT")
    pressed("v", "x", "\n", "q", "r")
    ran = course("watch doubling").ends(0)
    waiting = "Waiting for a save of doubling/doubling.py.\nKeys: h hint, v more, l lesson, t text, q leave\n"
    assert ran.out.count(waiting) == 2
    assert ran.out.endswith(waiting)


@pytest.mark.parametrize("words", [("go",), ("watch",)])
def test_the_next_task_opens_by_itself_when_one_passes(course, workspace, pressed, words):
    pressed(_solve("doubling"), _solve("halving"))
    ran = course(*words).ends(0, "Explained in: course lesson half-as-much")
    ran.says_in_order("Exercise 1 of 2: doubling", "All 2 public checks pass", "Exercise 2 of 2: halving")
    assert ran.out.endswith("Next: course submit  everything is done: hand it in\n")
    assert (workspace / "halving" / "halving.py").is_file(), "it was put there"


def test_what_is_in_the_files_already_counts(course, workspace, write, pressed):
    write("RIGHT", "RIGHT")
    pressed("q")
    said = course("go").says_in_order("All 2 public checks pass", "Exercise 2 of 2: halving")
    said.lacks("Write RIGHT")  # a file as it was handed out waits for its first save


def test_a_task_as_it_was_handed_out_is_checked_on_r_and_skipped_it_is_where_the_next_go_is_not(
    course, workspace, pressed
):
    pressed("r", "s", "q")
    said = course("go").says("Exercise 2 of 2").out
    assert said.count("Keys: r check, l lesson, t text, s skip, q leave") == 1
    assert said.count("Keys: v more, l lesson, t text, s skip, q leave") == 1
    pressed("q")
    course("go").lacks("Exercise 1 of 2")
    course("watch -C doubling").says("Exercise 1 of 2")  # a folder keeps to its task first


def test_keys_lead_to_other_tasks_and_back_and_a_task_that_is_done_stays(course, workspace, write, pressed):
    write("RIGHT", "RIGHT")
    course("check doubling")
    pressed("b", "s", "q")
    ran = course("go").says("b back, s skip")
    here, there = "Exercise 2 of 2: halving", "Exercise 1 of 2: doubling"
    assert [line for line in ran.rows if line.startswith("Exercise ")] == [here, there, here]


def test_the_lesson_the_text_and_the_way_back_are_keys(course, workspace, pressed, monkeypatch):
    ran = []

    def opened(words):
        ran.append(words)
        if len(ran) == 2:
            raise NotFoundError("There is no such lesson.", code="lesson_not_found")
        return 0

    monkeypatch.setattr(loop, "again", opened)
    pressed("l", "t", "l", "q")
    said = course("go").says("# Doubling")  # the whole text
    assert ran == [["lesson", "twice-as-much", "--page"]] * 2
    assert said.out.count("Waiting for a save of doubling/doubling.py.") == 4
    assert (said.code, said.err) == (0, "There is no such lesson.\n"), "and the loop goes on"


def test_with_no_task_left_nothing_is_handed_in_unasked(course, workspace, pressed, write):
    write("RIGHT", "RIGHT")
    course("check doubling")
    course("start halving")
    pressed(_solve("halving"))
    course("watch halving")
    course("check halving")
    for words in (("go",), ("watch",)):
        assert course(*words).out == "Next: course submit  everything is done: hand it in\n"
    assert course("watch --json").json["exercise"] == ""
    assert not list(workspace.glob("*.zip"))


def test_after_the_last_task_each_further_step_is_asked_about(course, workspace, person, monkeypatch):
    ran, asked, steps = [], [], iter(["course quiz take", "course submit", "course submit"])
    monkeypatch.setattr(loop, "next_task", lambda *_: None)
    monkeypatch.setattr(loop, "next_in_course", lambda *_: next(steps))
    monkeypatch.setattr(loop, "again", lambda words: ran.append((words, loop.current().led)) or 0)
    monkeypatch.setattr(Console, "go_on", lambda _, where: not asked.append(where))
    said = course("go").out
    assert ran == [(["quiz", "take"], True), (["submit"], True)], "what is next is said once, by the loop"
    assert len(asked) == said.count("Next: ") == 2


def test_a_named_watch_stays_with_its_exercise_and_works_where_the_record_cannot_be_read(
    course, workspace, pressed
):
    record = workspace / ".course" / "progress.sqlite"
    kept = record.read_bytes()
    record.write_bytes(b"not a database, not at all, no" * 10)
    pressed("q")
    assert course("watch doubling").code == 0
    assert course("go").code != 0
    record.write_bytes(kept)
    pressed(_solve("doubling"), "s", "b", "q")
    course("watch doubling").says("All 2 public checks pass").lacks("halving")


def test_q_while_checks_run_drops_them_and_records_nothing(watcher, session, write):
    write("wrong", "RIGHT")
    dropped, grade = threading.Event(), session.grade

    def slow(submission, only=None):
        assert dropped.wait(20)
        return grade(submission, only)

    session.drop, session.running, session.grade = dropped.set, "a check", slow
    watcher.pressed = SimpleNamespace(leave=True)
    assert watcher.look(session)
    assert watcher.runs == []
    assert not watcher.here.history(watcher.exercise).runs


def test_keys_are_taken_one_by_one_and_what_follows_q_stays_for_the_shell():
    import pty

    mine, terminal = pty.openpty()
    try:
        tty.setcbreak(terminal)
        os.write(mine, b"hqls\n")
        keys = loop.Keys(terminal)
        while not keys.leave:
            pass
        assert (keys.wait(1), keys.wait(1)) == ("h", "q")
        assert os.read(terminal, 9) == b"ls\n"
    finally:
        os.close(mine)
        os.close(terminal)


def test_what_broke_and_what_was_fixed_comes_first_but_not_what_was_not_written_before(
    watcher, session, write
):

    def shown(*bodies):
        before = len(_said(watcher))
        write(*bodies)
        watcher.look(session)
        return _said(watcher)[before:]

    first = shown("wrong", "raise NotImplementedError")
    assert not {"broke", "fixed"} & {*re.split(r"\W+", first + shown("wrong", "RIGHT"))}
    lines = shown("RIGHT", "wrong").splitlines()
    assert "broke" in lines[1]
    assert "fixed" in lines[2]


def test_a_newer_save_drops_the_run_and_is_checked_instead(watcher, session, write, monkeypatch):
    write("wrong", "RIGHT")
    dropped = threading.Event()
    grade = session.grade

    def slow(submission, only=None):
        if not dropped.is_set():
            write("RIGHT", "RIGHT")  # saved again while the checks run
            assert dropped.wait(20)
        return grade(submission, only)

    session.drop, session.running = dropped.set, "a check"
    monkeypatch.setattr(session, "grade", slow)
    assert watcher.look(session)
    assert [run.score for run in watcher.runs] == [4.0]
    assert "dropped" in _said(watcher)


def test_keys_give_a_hint_the_next_function_details_and_another_run(watcher, session, write):
    write("wrong", "wrong")
    watcher.look(session)
    watcher.press("h", session)
    assert watcher.here.history(watcher.exercise).hints
    watcher.press("n", session)
    focus = watcher._focus
    watcher.press("n", session)
    assert watcher._focus != focus
    watcher.press("v", session)
    assert watcher.verbose
    watcher.press("r", session)
    assert len(watcher.runs) == 2
    assert watcher.press("r", session)
    said = _said(watcher)
    assert not watcher.press("x", session)
    assert not watcher.press("\n", session)
    assert _said(watcher) == said


def test_beside_keys_no_command_is_named_for_what_is_kept_back(watcher, session, write):
    write("wrong", "also wrong")
    watcher.look(session)
    kept_back = "One function at a time in detail"
    assert kept_back in _said(watcher)
    read, write_end = os.pipe()
    watcher.pressed = loop.Keys(read)
    watcher.press("n", session)
    os.close(read)
    os.close(write_end)
    assert _said(watcher).count(kept_back) == 1
    assert "n next failing" in watcher.keys


def test_keys_name_a_hint_once_one_is_due_and_another_function_once_another_one_fails(
    watcher, session, write
):
    watcher.look(session)
    assert watcher.keys == ["v more"]
    write("wrong", "raise NotImplementedError")
    watcher.look(session)
    assert watcher.keys == ["h hint", "v more"]
    watcher.press("h", session)
    assert "h hint" not in watcher.keys
    write("wrong", "also wrong")
    watcher.look(session)
    assert watcher.keys == ["h hint", "n next failing", "v more"]
