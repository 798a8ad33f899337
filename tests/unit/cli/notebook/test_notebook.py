"""``course notebook``, notebooks that are handed in, and which file counts: the module or its notebook."""

import contextlib
import importlib.util
import json
import os
import queue
import subprocess
import urllib.error
import urllib.request
import zipfile
from pathlib import Path

import pytest

from course import browser
from course.cli.work import chosen as handing_in
from course.notebooks import server
from tests.unit.cli.conftest import needs_jupyterlab, record

GOOD = "def double(x):\n    'RIGHT'"
OTHER = "def doublings(x, n):\n    'RIGHT'"


def write_into(path, *texts):
    """Put functions into the cells of a generated notebook, as somebody who works in Jupyter does."""
    notebook = json.loads(path.read_text("utf-8"))
    places = [c for c in notebook["cells"] if c["metadata"].get("course", {}).get("role") == "solution"]
    for cell, text in zip(places, texts, strict=False):
        cell["source"] = text
        cell["outputs"] = [{"output_type": "stream", "name": "stdout", "text": "x" * 1000}]
        cell["execution_count"] = 3
    path.write_text(json.dumps(notebook), "utf-8")


@pytest.fixture
def notebook(course, workspace):
    """The exercise's notebook beside its stub, as it is generated."""
    assert course("notebook build doubling").code == 0
    return workspace / "doubling" / "doubling.ipynb"


def test_build_outside_of_a_workspace_makes_folders(course, tmp_path):
    reply = course("notebook build --json").ends(0).json
    assert reply["schema"] == "course.notebook/1"
    assert {file["action"] for file in reply["files"]} == {"written"}
    assert {Path(file["path"]).relative_to(tmp_path).as_posix() for file in reply["files"]} == {
        "notebooks/lessons/twice-as-much.ipynb",
        "notebooks/lessons/half-as-much.ipynb",
        "notebooks/exercises/doubling.ipynb",
        "notebooks/exercises/halving.ipynb",
        "notebooks/sandbox.ipynb",
    }


def test_build_and_update_keep_somebodys_work(course, notebook):
    write_into(notebook, GOOD)
    mine = notebook.read_bytes()
    for command in ("build", "update"):
        assert course("notebook", command, "doubling", "--json").json["files"][0]["action"] == "current"
        assert notebook.read_bytes() == mine
    older = json.loads(mine)
    older["metadata"]["course"]["version"] = "0"
    notebook.write_text(json.dumps(older))
    (file,) = course("notebook update --json").json["files"]
    assert file["action"] == "merged"
    assert Path(file["backup"]["backup"]).read_text() == json.dumps(older)
    assert GOOD in notebook.read_text("utf-8").encode().decode("unicode_escape")


def test_where_merging_is_not_safe_the_newer_one_is_put_beside(course, workspace):
    path = workspace / "doubling" / "doubling.ipynb"
    path.write_text("{}")
    course("notebook build doubling").ends(0, "not changed, since", "doubling/doubling.new.ipynb")
    assert path.read_text() == "{}"
    assert json.loads((workspace / "doubling" / "doubling.new.ipynb").read_text())["nbformat"] == 4


@pytest.mark.parametrize(
    ("words", "code", "error"),
    [
        (("update",), 5, "no_notebooks"),
        (("build", "nothing"), 5, "notebook_not_found"),
        (("build", "--format", "pdf"), 2, "unknown_format"),
        (("build", "--format", "nbgrader", "--executed"), 2, "executed_nbgrader"),
        (("check", "nothing.ipynb"), 5, "no_file"),
        (("check", "."), 2, "not_a_file"),
    ],
)
def test_what_cannot_be_used_is_refused(course, tmp_path, words, code, error):
    assert course("notebook", *words, "--json").error == (code, error)


def test_a_number_is_not_taken_for_a_lesson_or_an_exercise(course):
    said = course("notebook build 1 --json").json["error"]["help"]
    assert said.startswith("A number may be a lesson's or an exercise's: write the name.")


def test_check_says_what_is_wrong_and_passes_when_it_is_right(course, notebook):
    write_into(notebook, GOOD)
    course("notebook check", notebook).ends(1, "Still to do")
    write_into(notebook, GOOD, OTHER)
    ran = course("notebook check", notebook, "--json").ends(0)
    assert ran.json["schema"] == "course.notebook-check/1"
    assert ran.json["result"]["score"] == 4.0
    assert course("progress --json").json["exercises"][0]["score"] == 4.0


def test_check_finds_the_exercise_by_marks_name_or_functions(course, tmp_path):
    course("notebook build --out made")
    named = tmp_path / "made" / "exercises" / "doubling.ipynb"
    write_into(named, GOOD, OTHER)
    bare = json.loads(named.read_text("utf-8"))
    for cell in bare["cells"]:
        cell["metadata"] = {}
    for name in ("anything.ipynb", "doubling.ipynb"):
        (tmp_path / name).write_text(json.dumps(bare))
        assert course("notebook check", name, "--json").json["result"]["exercise"] == "doubling"
    (tmp_path / "other.ipynb").write_text('{"nbformat": 4, "cells": [], "metadata": {}}')
    assert course("notebook check other.ipynb --json").json["error"]["code"] == "which_exercise"
    ran = course("notebook check other.ipynb --exercise doubling --json")
    assert ran.error == (3, "no_declared_functions")


def handed_in(workspace):
    with zipfile.ZipFile(workspace / "mini-submission.zip") as archive:
        return {name: archive.read(name) for name in archive.namelist()}


def test_submit_hands_in_the_notebook_where_the_module_is_still_the_stub_or_gone(course, workspace, notebook):
    assert course("submit --json").json["error"]["code"] == "nothing_to_submit"
    write_into(notebook, GOOD, OTHER)
    course("notebook check", notebook)
    for _ in range(2):
        body = course("submit --json").json
        assert [file["path"] for file in body["files"]] == ["doubling/doubling.ipynb"]
        assert body["files"][0]["last_score"] == 4.0
        assert body["left_out"] == []
        sent = json.loads(handed_in(workspace)["doubling/doubling.ipynb"])
        assert all(cell.get("outputs") in (None, []) for cell in sent["cells"])
        notebook.with_suffix(".py").unlink(missing_ok=True)


def test_submit_hands_in_the_module_where_both_were_worked_in_and_says_so(course, workspace, notebook, write):
    write_into(notebook, GOOD)
    write("RIGHT")
    ran = course("submit")
    assert "Left out: doubling/doubling.ipynb (doubling.py was worked in too, and is handed in)." in ran.out
    assert {*handed_in(workspace)} == {"doubling/doubling.py", "submission.json"}


def test_a_notebook_under_another_name_is_told_wherever_it_is_not_read(course, workspace, notebook):
    """As JupyterLab's Duplicate and Rename leave it."""
    notebook.with_suffix(".py").unlink()
    write_into(notebook, GOOD)
    copy = notebook.with_name("doubling-Copy1.ipynb")
    copy.write_bytes(notebook.read_bytes())
    assert "Copy1" not in course("check doubling").err  # the same work twice
    write_into(copy, GOOD, OTHER)
    os.utime(notebook, (1, 1))  # the copy was saved last
    unread = "doubling/doubling-Copy1.ipynb is not read: the file that counts is doubling.ipynb."
    course("check doubling").warns(unread)
    course("submit").warns(unread)
    os.utime(copy, (0, 0))  # a copy that was put away: nothing to say
    assert "Copy1" not in course("check doubling").err

    notebook.unlink()
    course("check doubling").refuses(3, "rename it to doubling.ipynb")
    course("submit").ends(3, "doubling-Copy1.ipynb is not read under that name")
    course("notebook build doubling")
    gone = "doubling/doubling.py (not there; doubling-Copy1.ipynb is not read under that name)"
    course("submit").ends(3, gone)
    course("start doubling")
    course("submit").ends(3, "still the stub; doubling-Copy1.ipynb is not read under that name")


def test_reset_takes_the_notebook_where_that_is_what_counts(course, workspace, notebook):
    """And `start` names it, where both are there."""
    write_into(notebook, GOOD)
    mine = notebook.read_bytes()
    assert "write your code in doubling/doubling.ipynb" in course("start doubling").out
    for _ in range(2):
        body = course("reset doubling --yes --json").json
        assert [item["path"] for item in body["backups"]] == [str(notebook)]
        assert (workspace / body["backups"][0]["backup"]).read_bytes() == mine
        assert GOOD not in notebook.read_text("utf-8")
        notebook.with_suffix(".py").unlink(missing_ok=True)  # then there is only the notebook
        notebook.write_bytes(mine)
    assert not notebook.with_suffix(".py").exists()


def test_submit_says_why_a_notebook_cannot_go_in(course, notebook, write, monkeypatch):
    """Just below the depth at which the grading run's reader gives up, ours may have given up already."""

    def too_deep(_data):
        raise RecursionError

    write_into(notebook, GOOD)
    with monkeypatch.context() as deep:
        deep.setattr(handing_in, "_without_outputs", too_deep)
        course("submit").ends(3, "doubling/doubling.ipynb (its outputs cannot be read")
    write("RIGHT")
    notebook.write_text("not a notebook")
    (left_out,) = course("submit --json").ends(0).json["left_out"]
    assert left_out["path"] == "doubling/doubling.ipynb"
    assert "is not a notebook" in left_out["action"]


def test_nbgrader_notebooks_carry_its_marks(course, tmp_path):
    assert course("notebook build doubling --format nbgrader --out site").code == 0
    path = tmp_path / "site" / "source" / "doubling" / "doubling.ipynb"
    cells = json.loads(path.read_text("utf-8"))["cells"]
    marks = [cell["metadata"]["nbgrader"] for cell in cells if "nbgrader" in cell["metadata"]]
    assert len({mark["grade_id"] for mark in marks}) == len(marks)
    assert all(mark["schema_version"] == 3 for mark in marks)
    graded = [mark for mark in marks if mark["grade"]]
    assert graded
    assert all(mark["locked"] and mark["points"] > 0 and not mark["solution"] for mark in graded)
    for cell in cells:
        if cell["metadata"].get("nbgrader", {}).get("solution"):
            text = "".join(cell["source"])
            assert text.index("def ") < text.index("### BEGIN SOLUTION") < text.index("### END SOLUTION")


def test_open_and_executed_say_in_one_sentence_what_is_missing(course, workspace, monkeypatch):
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None if name == "jupyterlab" else object())
    error = course("open doubling --json").ends(4).json["error"]
    assert error["message"] == "Opening a notebook needs jupyterlab, which is not installed."
    assert error["help"].startswith("Install what it needs: pip install 'jupyterlab")
    assert not (workspace / "doubling" / "doubling.ipynb").exists()
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    ran = course("notebook build --executed --json")
    assert ran.error == (4, "missing_extra")
    ran.warns("'jupyterlab>=4", "'nbclient", "'ipykernel", "'anywidget")
    course("notebook build").ends(0)


@needs_jupyterlab
def test_open_leaves_it_to_the_course_whether_a_browser_is_opened(course, workspace, monkeypatch):
    """JupyterLab by itself starts one in the terminal where there is no display."""
    said = []

    def started(command, **_):
        said.extend(command)
        raise KeyboardInterrupt

    monkeypatch.setattr(subprocess, "Popen", started)
    assert course("open trebling").code == 5
    assert said == []
    course("open doubling")
    assert {"jupyterlab", "--no-browser"} <= {*said}


@needs_jupyterlab
@pytest.mark.parametrize("display", ["", ":0"])
def test_open_shows_a_page_or_says_how_to_get_to_it(course, workspace, monkeypatch, display):
    shown = queue.Queue()
    lab = server.Lab("http://localhost:8888/lab?token=1", None)
    monkeypatch.setattr(server, "started", lambda *_: contextlib.nullcontext(lab))
    monkeypatch.setattr(server.Lab, "wait", lambda _: 0)
    monkeypatch.setattr(browser, "opened", shown.put)
    monkeypatch.setattr("sys.platform", "linux")
    for name in ("BROWSER", "WAYLAND_DISPLAY"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("DISPLAY", display)
    ran = course("open doubling").says(f"is at {lab.address}")
    assert ("ssh -N -L 8888:127.0.0.1:8888" in ran.out) is (not display)
    assert shown.get(timeout=30) == lab.address if display else shown.empty()


@needs_jupyterlab
@pytest.mark.parametrize("wanted", ["doubling", None])
def test_open_prints_an_address_that_lets_one_in_and_leaves_what_is_there(
    course, workspace, notebook, monkeypatch, wanted
):
    """The server is asked while the command waits for it to end."""
    write_into(notebook, GOOD)
    mine = notebook.read_bytes()
    said = []

    def wait(lab):
        contents = lab.address.replace("/lab/tree/", "/api/contents/").replace("/lab?", "/api/contents?")
        for address in (lab.address, contents, contents.partition("?")[0]):
            try:
                with urllib.request.urlopen(address) as page:
                    said.append((page.status, page.read()))
            except urllib.error.HTTPError as error:
                said.append((error.code, b""))
        return 0

    monkeypatch.setattr(server.Lab, "wait", wait)
    monkeypatch.setenv("JUPYTER_RUNTIME_DIR", str(workspace.parent / "runtime"))
    ran = course("open", *([wanted] if wanted else []), "--no-browser", "--json").ends(0)
    assert ran.json["schema"] == "course.open/1"
    assert "token=" in ran.json["address"]
    (lab, _), (contents, listing), (stranger, _) = said
    assert (lab, contents, stranger) == (200, 200, 403)
    names = {"doubling.ipynb"} if wanted else {"doubling", "lessons", "sandbox.ipynb"}
    about = json.loads(listing)
    inside = [one["name"] for one in about["content"]] if about["type"] == "directory" else []
    assert names <= {about["name"], *inside}
    assert {file["id"]: file["action"] for file in ran.json["files"]}["doubling"] == "kept"
    assert notebook.read_bytes() == mine
    with pytest.raises(urllib.error.URLError):  # it ends with the command
        urllib.request.urlopen(ran.json["address"])


@needs_jupyterlab
def test_a_jupyterlab_that_does_not_start_is_quoted(course, workspace, monkeypatch, tmp_path):
    stand_in = tmp_path / "python"
    stand_in.write_text("#!/bin/sh\necho 'no room left \033[31m' >&2\nexit 3\n")
    stand_in.chmod(0o755)
    monkeypatch.setattr(server.sys, "executable", str(stand_in))
    ran = course("open doubling").refuses(
        70, "JupyterLab ended before it was ready (exit code 3).", "It said:\nno room left"
    )
    assert "\033[31m" not in ran.err


WRONG = "def double(x):\n    'wrong'"


def test_check_reads_the_notebook_where_the_module_is_still_the_stub_and_says_so(course, notebook):
    write_into(notebook, GOOD, OTHER)
    course("check doubling").ends(0, "Reading doubling/doubling.ipynb.")
    assert course("check --json").json["score"] == 4.0


def test_check_reads_the_module_where_nobody_worked_in_the_notebook_while_there_is_one(
    course, notebook, write
):
    assert "Reading" not in course("check doubling").out
    write("RIGHT", "RIGHT")
    ran = course("check doubling").ends(0)
    assert "Reading" not in ran.out + ran.err
    notebook.with_suffix(".py").unlink()
    course("check doubling").ends(1, "Reading doubling/doubling.ipynb.")


def test_where_both_were_worked_in_the_module_counts_and_the_other_is_named(course, notebook, write):
    write("RIGHT", "RIGHT")
    write_into(notebook, WRONG)
    course("check doubling").ends(0, "Reading doubling/doubling.py.").warns(
        "doubling/doubling.ipynb was worked in too and holds other code",
        "course check doubling/doubling.ipynb",
    )
    named = course("check doubling/doubling.ipynb").ends(1, "Reading doubling/doubling.ipynb.")
    assert "worked in too" not in named.err
    write_into(notebook, GOOD, OTHER)
    notebook.with_suffix(".py").write_text(f'"""Doubling."""\n\n{GOOD}\n\n\n{OTHER}\n')
    assert "worked in too" not in course("check doubling").err, "the same code in both"


def test_a_file_may_be_named_from_anywhere_but_not_one_that_is_no_exercises(course, notebook, monkeypatch):
    (notebook.parent / "other.ipynb").write_bytes(notebook.read_bytes())
    ran = course("check doubling/other.ipynb --json").warns("course notebook check")
    assert ran.error == (5, "exercise_not_found")
    monkeypatch.chdir(notebook.parent)
    for words in ("doubling.py", "./doubling.ipynb", "../doubling/doubling.ipynb"):
        assert course("check", words, "--json").json["exercise"] == "doubling"


def test_a_damaged_notebook_is_not_taken_for_an_untouched_one(course, notebook):
    notebook.write_text("not a notebook")
    assert course("check doubling --json").error == (3, "not_a_notebook")
    assert course("check doubling/doubling.py").code == 1


def test_a_check_says_what_was_left_out_of_a_notebook(course, notebook):
    write_into(notebook, f"{GOOD}\n!ls")
    assert any("left out" in note for note in course("check doubling --json").json["warnings"])


def test_check_all_takes_a_notebook_that_was_never_started(course, workspace):
    course("notebook build halving")
    assert [one["exercise"] for one in course("check --all --json").json["results"]] == ["doubling"]
    write_into(workspace / "halving" / "halving.ipynb", "def halve(x):\n    'RIGHT'")
    results = course("check --all --json").json["results"]
    assert [one["exercise"] for one in results] == ["doubling", "halving"]
    assert results[1]["score"] > 0


def test_a_notebook_needs_no_start(course, workspace, write):
    write("RIGHT", "RIGHT")
    course("check doubling")
    for lesson in ("twice-as-much", "half-as-much"):
        record(workspace).append("lesson", lesson)
    course("notebook build halving")
    assert course("progress --json").json["next"]["command"] == "course check halving"
    write_into(workspace / "halving" / "halving.ipynb", "def halve(x):\n    'wrong'")
    assert course("check halving").code == 1
    assert course("progress --json").json["next"]["command"] == "course check halving"


def test_a_notebook_is_recorded_as_the_module_is_and_submit_knows_it(course, workspace, notebook):
    write_into(notebook, GOOD, OTHER)
    course("check doubling")
    notebook.with_suffix(".py").write_text(f"{GOOD}\n\n\n{OTHER}\n")
    course("check doubling")
    first, second = (dict(event.data) for event in record(workspace).events("check"))
    for told in (first, second):
        told.pop("seconds")
        told.pop("sha256")
    assert first == second
    notebook.with_suffix(".py").unlink()
    assert course("submit --json").json["files"][0]["last_score"] == 4.0


def test_a_hint_follows_a_failed_check_of_the_notebook_but_not_of_its_stub(course, notebook):
    course("check doubling/doubling.ipynb")
    reply = course("hint doubling/doubling.ipynb --json").json
    assert (reply["given"], reply["reason"]) == (False, "unchanged")
    assert "doubling.ipynb" in reply["message"]
    write_into(notebook, WRONG)
    course("check doubling")
    assert course("hint doubling --json").json["given"]
    again = course("hint doubling --json").json
    assert "changed code in doubling.ipynb" in again["message"]


def test_a_diff_of_a_notebook_is_of_its_code(course, notebook):
    assert not course("diff doubling/doubling.ipynb --json").json["changed"]
    write_into(notebook, WRONG)
    ran = course("diff doubling --json")
    assert ran.json["path"] == str(notebook)
    assert "+    'wrong'" in ran.json["diff"]
    assert "doublings" not in "".join(row for row in ran.json["diff"].splitlines() if row[:1] in "+-")
    assert "xxx" not in ran.json["diff"]


def test_a_report_on_a_notebook_names_its_cells(course, notebook):
    write_into(notebook, "def double(x):\n    return x + x", "def doublings(x, n):\n    return x / 0")
    ran = course("report doubling --plain").ends(
        0, "Reading doubling/doubling.ipynb.", "number: 2.5; double: 5"
    )
    cells = json.loads(notebook.read_text("utf-8"))["cells"]
    number = next(n for n, cell in enumerate(cells, 1) if "x / 0" in "".join(cell["source"]))
    assert f"in cell {number}, line 2 of your notebook" in ran.out
    write_into(notebook, "def double(x):\n    'RIGHT'\n    if x > 0\n        return x")
    course("report doubling --plain").ends(
        0, "Python cannot read `double` in cell ", ", line 3 of your notebook: expected ':'"
    )


def test_a_watch_of_a_notebook_grades_each_save(notebook, watcher, session):
    write_into(notebook, GOOD)
    assert watcher.look(session)
    assert not watcher.look(session)
    for text in ("{", json.dumps({"nbformat": 4, "cells": [], "metadata": {}})):
        notebook.write_text(text)
        assert watcher.look(session)
    assert [run.state for run in watcher.runs] == ["graded", "ungradable", "ungradable"]
    assert watcher.runs[0].score == 2.0


def test_one_check_alone_does_not_make_an_exercise_complete(course, write):
    write("RIGHT", "wrong")

    def state_after(*lines):
        for line in lines:
            course(line)
        return course("progress --json").json["exercises"][0]["state"]

    assert state_after("check --only double_works") == "failing"
    assert state_after("check", "check --only double_works") == "failing"
    write("RIGHT", "RIGHT")
    assert state_after("check") == "complete"
    write("wrong", "RIGHT")
    assert state_after("check --only double_works") != "complete"
