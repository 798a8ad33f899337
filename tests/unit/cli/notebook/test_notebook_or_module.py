"""The file of an exercise that counts: the module, or the notebook that was worked in instead."""

import io
import json
from pathlib import Path

import pytest

from course.cli.frame.console import Console, Settings
from course.cli.frame.here import Here
from course.cli.loop import Watcher
from course.handed_in import attempts as sessions
from tests.unit.cli.conftest import record
from tests.unit.cli.notebook.test_notebook import GOOD, OTHER, write_into

WRONG = "def double(x):\n    'wrong'"


@pytest.fixture
def notebook(course, workspace) -> Path:
    """The exercise's notebook beside its stub, as it is generated."""
    assert course("notebook", "build", "doubling").code == 0
    return workspace / "doubling" / "doubling.ipynb"


def test_check_reads_the_notebook_where_the_module_is_still_the_stub_and_says_so(course, notebook):
    write_into(notebook, GOOD, OTHER)
    ran = course("check", "doubling")
    assert ran.code == 0
    assert "Reading doubling/doubling.ipynb." in ran.out
    assert course("check", "--json").json["score"] == 4.0


def test_check_reads_the_module_where_nobody_worked_in_the_notebook_while_there_is_one(
    course, notebook, write
):
    assert "Reading" not in course("check", "doubling").out
    write("RIGHT", "RIGHT")
    ran = course("check", "doubling")
    assert ran.code == 0
    assert "Reading" not in ran.out + ran.err
    notebook.with_suffix(".py").unlink()
    ran = course("check", "doubling")
    assert ran.code == 1
    assert "Reading doubling/doubling.ipynb." in ran.out


def test_where_both_were_worked_in_the_module_counts_and_the_other_is_named(course, notebook, write):
    write("RIGHT", "RIGHT")
    write_into(notebook, WRONG)
    ran = course("check", "doubling")
    assert ran.code == 0
    assert "Reading doubling/doubling.py." in ran.out
    assert "doubling/doubling.ipynb was worked in too and holds other code" in ran.err
    assert "course check doubling/doubling.ipynb" in ran.err
    named = course("check", "doubling/doubling.ipynb")
    assert named.code == 1
    assert "Reading doubling/doubling.ipynb." in named.out
    assert "worked in too" not in named.err
    write_into(notebook, GOOD, OTHER)
    notebook.with_suffix(".py").write_text(f'"""Doubling."""\n\n{GOOD}\n\n\n{OTHER}\n')
    assert "worked in too" not in course("check", "doubling").err, "the same code in both"


def test_a_file_may_be_named_from_anywhere_but_not_one_that_is_no_exercises(course, notebook, monkeypatch):
    (notebook.parent / "other.ipynb").write_bytes(notebook.read_bytes())
    ran = course("check", "doubling/other.ipynb", "--json")
    assert (ran.code, ran.json["error"]["code"]) == (5, "exercise_not_found")
    assert "course notebook check" in ran.json["error"]["help"]
    monkeypatch.chdir(notebook.parent)
    for words in ("doubling.py", "./doubling.ipynb", "../doubling/doubling.ipynb"):
        assert course("check", words, "--json").json["exercise"] == "doubling"


def test_a_damaged_notebook_is_not_taken_for_an_untouched_one(course, notebook):
    notebook.write_text("not a notebook")
    ran = course("check", "doubling", "--json")
    assert (ran.code, ran.json["error"]["code"]) == (3, "not_a_notebook")
    assert course("check", "doubling/doubling.py").code == 1


def test_a_check_says_what_was_left_out_of_a_notebook(course, notebook):
    write_into(notebook, f"{GOOD}\n!ls")
    assert any("left out" in note for note in course("check", "doubling", "--json").json["warnings"])


def test_check_all_takes_a_notebook_that_was_never_started(course, workspace):
    course("notebook", "build", "halving")
    assert [one["exercise"] for one in course("check", "--all", "--json").json["results"]] == ["doubling"]
    write_into(workspace / "halving" / "halving.ipynb", "def halve(x):\n    'RIGHT'")
    results = course("check", "--all", "--json").json["results"]
    assert [one["exercise"] for one in results] == ["doubling", "halving"]
    assert results[1]["score"] > 0


def test_what_was_checked_in_a_notebook_needs_no_start(course, workspace, write):
    write("RIGHT", "RIGHT")
    course("check", "doubling")
    for lesson in ("twice-as-much", "half-as-much"):
        record(workspace).append("lesson", lesson)
    course("notebook", "build", "halving")
    assert course("progress", "--json").json["next"]["command"] == "course start halving"
    write_into(workspace / "halving" / "halving.ipynb", "def halve(x):\n    'wrong'")
    course("check", "halving/halving.ipynb")
    assert course("progress", "--json").json["next"]["command"] == "course check halving"


def test_a_notebook_is_recorded_as_the_module_is_and_submit_knows_it(course, workspace, notebook):
    write_into(notebook, GOOD, OTHER)
    course("check", "doubling")
    notebook.with_suffix(".py").write_text(f"{GOOD}\n\n\n{OTHER}\n")
    course("check", "doubling")
    first, second = (dict(event.data) for event in record(workspace).events("check"))
    for told in (first, second):
        told.pop("seconds")
        told.pop("sha256")
    assert first == second
    notebook.with_suffix(".py").unlink()
    assert course("submit", "--json").json["files"][0]["last_score"] == 4.0


def test_a_hint_follows_a_failed_check_of_the_notebook_but_not_of_its_stub(course, notebook):
    course("check", "doubling/doubling.ipynb")
    reply = course("hint", "doubling/doubling.ipynb", "--json").json
    assert (reply["given"], reply["reason"]) == (False, "unchanged")
    assert "doubling.ipynb" in reply["message"]
    write_into(notebook, WRONG)
    course("check", "doubling")
    assert course("hint", "doubling", "--json").json["given"]
    again = course("hint", "doubling", "--json").json
    assert "changed code in doubling.ipynb" in again["message"]


def test_a_diff_of_a_notebook_is_of_its_code(course, notebook):
    assert not course("diff", "doubling/doubling.ipynb", "--json").json["changed"]
    write_into(notebook, WRONG)
    ran = course("diff", "doubling", "--json")
    assert ran.json["path"] == str(notebook)
    assert "+    'wrong'" in ran.json["diff"]
    assert "doublings" not in "".join(row for row in ran.json["diff"].splitlines() if row[:1] in "+-")
    assert "xxx" not in ran.json["diff"]


def test_a_report_on_a_notebook_names_its_cells(course, notebook):
    write_into(notebook, "def double(x):\n    return x + x", "def doublings(x, n):\n    return x / 0")
    ran = course("report", "doubling", "--plain")
    assert ran.code == 0
    assert "Reading doubling/doubling.ipynb." in ran.out
    assert "number: 2.5; double: 5" in ran.out
    cells = json.loads(notebook.read_text("utf-8"))["cells"]
    number = next(n for n, cell in enumerate(cells, 1) if "x / 0" in "".join(cell["source"]))
    assert f"in cell {number}, line 2 of your notebook" in ran.out
    write_into(notebook, "def double(x:")
    ran = course("report", "doubling", "--plain")
    assert ran.code == 0
    assert "Python cannot read `double` in cell " in ran.out


def test_a_watch_of_a_notebook_grades_each_save(course, notebook):
    here = Here.load()
    exercise = here.exercise("doubling")
    console = Console(Settings(), stdout=io.StringIO(), stderr=io.StringIO())
    watcher = Watcher(console=console, here=here, exercise=exercise)
    session = sessions.open_session(exercise, here.catalog)
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
    course("check", "--only", "double_works")
    assert course("progress", "--json").json["exercises"][0]["state"] == "failing"
    course("check")
    course("check", "--only", "double_works")
    assert course("progress", "--json").json["exercises"][0]["state"] == "failing"
    write("RIGHT", "RIGHT")
    course("check")
    assert course("progress", "--json").json["exercises"][0]["state"] == "complete"
    write("wrong", "RIGHT")
    course("check", "--only", "double_works")
    assert course("progress", "--json").json["exercises"][0]["state"] != "complete"
