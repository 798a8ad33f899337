"""Cells run in a process of their own, after what they need, and can be stopped."""

import io
import threading
import time
import zipfile

import pytest

from course.catalog.load import Catalog
from course.reading.cells import STOPPED, CellRunner, textbook_for
from course.reading.parts import Cell, read_script


def cell(order, source, *, hidden=False):
    return Cell(0 if hidden else order + 1, order, order, f"key{order}", source, None)


CELLS = [
    cell(0, "a = 2\nprint('first')"),
    cell(1, "secret = 40", hidden=True),
    cell(2, "unused = open('nowhere')", hidden=True),
    cell(3, "print(a + secret)"),
    cell(4, "print('before')\n1 / 0"),
    cell(5, "print('so far', flush=True)\nwhile True:\n    pass"),
    cell(6, "from course.physics.systems import Oscillator\nprint(Oscillator(omega=2.0).omega)"),
]


@pytest.fixture(scope="module")
def changed():
    """What cells were changed to."""
    return {}


@pytest.fixture
def sources(changed):
    yield changed
    changed.clear()


@pytest.fixture(scope="module")
def runner(changed):
    made = CellRunner(CELLS, lambda one: changed.get(one.key, one.source))
    yield made
    made.close()


def test_a_cell_runs_after_what_it_needs_and_hidden_ones_only_if_they_are_used(runner):
    gave = runner.run(CELLS[3])
    assert (gave.printed, gave.error, gave.earlier) == ("42", "", (1,))
    again = runner.run(CELLS[3])
    assert (again.printed, again.earlier) == ("42", ())


def test_a_changed_cell_runs_again_for_those_after_it(runner, sources):
    sources["key0"] = "a = 3"
    gave = runner.run(CELLS[3])
    assert (gave.printed, gave.earlier) == ("43", (1,))
    del sources["key0"]
    assert runner.run(CELLS[3]).printed == "42"


def test_a_process_that_ends_is_told_once(runner, sources):
    sources["key0"] = "import os\nos._exit(3)"
    assert runner.run(CELLS[0]).error == "The cell's process ended by itself (exit code 3)."


def test_an_error_is_told_by_the_cells_own_lines(runner):
    gave = runner.run(CELLS[4])
    assert gave.printed == "before"
    assert 'File "cell 5", line 2' in gave.error
    assert "1 / 0" in gave.error
    assert gave.error.endswith("ZeroDivisionError: division by zero")
    assert "lesson.py" not in gave.error


def test_a_cell_that_hangs_is_stopped_and_the_next_run_starts_anew(runner, sources):
    sources["key4"] = "pass"
    timer = threading.Timer(0.5, runner.interrupt)
    timer.start()
    begin = time.monotonic()
    gave = runner.run(CELLS[5])
    assert time.monotonic() - begin < 60.0  # wall: takes 0.6 s, a cell that is not stopped takes for ever
    assert (gave.printed, gave.error) == ("so far", STOPPED)
    sources["key5"] = "pass"
    assert runner.run(CELLS[3]).printed == "42"


def test_a_long_output_ends_with_a_whole_line_and_says_so_and_the_next_cell_prints(runner, sources):
    sources["key0"] = "for a in range(10**5):\n    print(a)"
    *rows, last, said = runner.run(CELLS[0]).printed.splitlines()
    assert rows == [str(number) for number in range(len(rows))]
    assert (last, "was dropped" in said) == ("...", True)
    sources["key0"] = "a = 2"
    assert runner.run(CELLS[3]).printed == "42"


def test_the_textbook_is_there_and_the_rest_of_the_course_is_not(runner, sources):
    sources["key4"] = sources["key5"] = "pass"
    assert runner.run(CELLS[6]).printed == "2.0"
    sources["key6"] = "from course.physics.exact import oscillator\nprint(oscillator.__name__)"
    assert runner.run(CELLS[6]).printed == "oscillator"  # what a changed cell names is handed to it
    sources["key6"] = "import importlib\nimportlib.import_module('course.progress.store')"
    assert "No module named 'course.progress'" in runner.run(CELLS[6]).error


def test_an_earlier_cell_that_fails_is_named(runner, sources):
    sources["key0"] = "print(nothing_of_that_name)"
    gave = runner.run(CELLS[3])
    assert gave.error.startswith("Cell 1, which this one needs, did not run.")
    assert "NameError" in gave.error


def test_no_more_of_the_course_than_is_imported_is_handed_over():
    book = textbook_for(["from course.physics.body import Body"])
    names = set(zipfile.ZipFile(io.BytesIO(book.data)).namelist())
    assert {"course/physics/body.py", "course/physics/state.py"} <= names
    assert not {name for name in names if not name.startswith(("course/physics/", "course/__init__"))}
    assert book.absent == ()
    assert textbook_for(["from course.figures import sim_to_real"]).absent == ("matplotlib",)
    assert textbook_for(["from course.physics.body import Body"]).data == book.data


@pytest.mark.parametrize(("name", "cells"), [("engines", 3), ("forward-inverse-kinematic", 5)])
def test_cells_of_lessons_print_here_what_the_lesson_records(name, cells):
    """One lesson reads a file of the package, the other imports a module that draws."""
    script = read_script(Catalog().lesson(name))
    runner = CellRunner(script.cells, lambda one: one.source)
    try:
        for one in script.shown_cells[:cells]:
            gave = runner.run(one)
            assert (gave.printed, gave.error) == (one.output or "", ""), one.number
    finally:
        runner.close()
