"""A verdict after every save, however the editor saves."""

from __future__ import annotations

import contextlib
import io
import itertools
import os
import threading
import time

import pytest

from course.cli.frame.console import Console, Settings
from course.cli.frame.here import Here
from course.cli.work.watching import Watcher, saves
from course.handed_in import attempts


@pytest.fixture
def watching(course, workspace, write):
    """A watcher of ``doubling`` and its session, warm."""
    here = Here.load()
    exercise = here.exercise("doubling")
    watcher = Watcher(
        console=Console(Settings(), stdout=io.StringIO(), stderr=io.StringIO()), here=here, exercise=exercise
    )
    return watcher, attempts.open_session(exercise, here.catalog)


def _said(watcher):
    return watcher.console._out.getvalue()


def test_each_save_is_graded_once(watching, write):
    watcher, session = watching
    write("wrong", "RIGHT")
    assert watcher.look(session)
    assert not watcher.look(session)
    write("RIGHT", "RIGHT")
    assert watcher.look(session)
    assert [run.score for run in watcher.runs] == [2.0, 4.0]
    assert watcher.last.ok


def test_a_file_put_in_the_place_of_the_old_one_is_a_save(watching, write, workspace):
    watcher, session = watching
    path = write("wrong", "wrong")
    watcher.look(session)
    before = path.stat()
    scratch = workspace / "doubling" / "scratch"
    scratch.write_bytes(path.read_bytes().replace(b"wrong", b"RIGHT"))
    os.utime(scratch, ns=(before.st_atime_ns, before.st_mtime_ns))
    scratch.replace(path)
    assert watcher.look(session)
    assert watcher.last.ok


def test_a_file_that_goes_is_waited_for(watching, write):
    watcher, session = watching
    write("RIGHT", "RIGHT").unlink()
    assert not watcher.look(session)
    assert not watcher.look(session)
    assert _said(watcher).count("is gone") == 1
    write("RIGHT", "RIGHT")
    assert watcher.look(session)


def test_a_file_that_is_written_in_two_goes_is_graded_whole(watching, write, workspace):
    watcher, session = watching
    path = workspace / "doubling" / "doubling.py"
    whole = write("RIGHT", "RIGHT").read_bytes()
    path.write_bytes(b"")
    late = threading.Timer(0.02, lambda: path.write_bytes(whole))
    late.start()
    assert watcher.look(session)
    late.join()
    assert watcher.last.ok
    assert len(watcher.runs) == 1


def test_a_file_that_cannot_run_is_reported_and_the_watch_goes_on(watching, write):
    watcher, session = watching
    write(extra="UNREADABLE")
    assert watcher.look(session)
    assert "Line 1 cannot be read." in _said(watcher)
    assert watcher.last.exit_code == 3
    write("RIGHT", "RIGHT")
    assert watcher.look(session)
    assert watcher.last.ok


def test_every_verdict_is_recorded(watching, write, course):
    watcher, session = watching
    write("wrong", "RIGHT")
    watcher.look(session)
    assert course("hint", "--json").json["given"]


def test_a_fault_of_the_grader_ends_the_watch(watching, write):
    from course.errors import CourseError

    watcher, session = watching
    write(extra="FAULT")
    with pytest.raises(CourseError):
        watcher.look(session)


@pytest.mark.parametrize("how", ["write", "rename", "after the folder was moved away and back"])
def test_saves_are_noticed_quickly(tmp_path, how):
    folder = tmp_path / "doubling"
    folder.mkdir()
    path = folder / "doubling.py"
    path.write_text("one")
    noticed = saves(path)
    next(noticed)
    done: list[float] = []

    def save():
        time.sleep(0.6)
        if how.startswith("after"):
            folder.rename(tmp_path / "away")
            time.sleep(1.5)
            (tmp_path / "away").rename(folder)
            time.sleep(1.0)
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


def test_ctrl_c_ends_a_watch_with_its_one_object(course, workspace, write, monkeypatch):
    from course.cli.work import watching as module

    write("wrong", "RIGHT")

    def two_saves(path):
        yield
        path.write_text(path.read_text().replace("wrong", "RIGHT"))
        yield
        raise KeyboardInterrupt

    monkeypatch.setattr(module, "saves", two_saves)
    ran = course("watch", "--json")
    assert ran.code == 130
    body = ran.json
    assert (body["schema"], body["exit_code"], body["exercise"]) == ("course.watch/1", 130, "doubling")
    assert [run["score"] for run in body["runs"]] == [2.0, 4.0]
    assert body["last"]["schema"] == "course.check/1"


def test_each_verdict_and_each_answer_to_a_key_ends_with_the_keys_and_the_file(
    course, workspace, write, monkeypatch
):
    from types import SimpleNamespace

    from course.cli.work import watching as module

    write("wrong", "RIGHT")
    pressed = iter(("", "v", "x\n", "q"))
    monkeypatch.setattr(module, "saves", lambda path, wake: itertools.repeat(None))
    keys = SimpleNamespace(taken=lambda: list(next(pressed)))
    monkeypatch.setattr(module, "_keys", lambda console, wake: contextlib.nullcontext(keys))
    ran = course("watch")
    assert ran.code == 0
    assert ran.out.count("Waiting for a save of doubling/doubling.py. Keys: h next hint") == 2
    assert ran.out.endswith("q leave.\n")


def test_there_must_be_a_file_to_begin_with(course, workspace):
    (workspace / "doubling" / "doubling.py").unlink()
    assert course("watch", "doubling").code == 3


def test_what_broke_and_what_was_fixed_comes_first(watching, write):
    watcher, session = watching
    write("wrong", "RIGHT")
    watcher.look(session)
    assert "broke" not in _said(watcher)
    before = len(_said(watcher))
    write("RIGHT", "wrong")
    watcher.look(session)
    lines = _said(watcher)[before:].splitlines()
    assert "broke" in lines[1]
    assert "fixed" in lines[2]


def test_a_newer_save_drops_the_run_and_is_checked_instead(watching, write, monkeypatch):
    watcher, session = watching
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


def test_keys_give_a_hint_the_next_function_details_and_another_run(watching, write):
    watcher, session = watching
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
    said = len(_said(watcher))
    assert not watcher.press("x", session)
    assert not watcher.press("\n", session)
    assert len(_said(watcher)) == said


def test_keys_name_a_hint_once_one_is_due_and_another_function_once_another_one_fails(watching, write):
    watcher, session = watching
    watcher.look(session)
    assert watcher.keys == "v details, r again, q leave"
    write("wrong", "raise NotImplementedError")
    watcher.look(session)
    assert watcher.keys == "h next hint, v details, r again, q leave"
    watcher.press("h", session)
    assert "next hint" not in watcher.keys
    write("wrong", "also wrong")
    watcher.look(session)
    assert watcher.keys == "h next hint, n next failing function, v details, r again, q leave"
