"""A newer notebook never costs anybody their work."""

import copy
import json

import pytest

from course.handed_in.notebook import notebook_source
from course.notebooks.build import exercise_cells
from course.notebooks.cells import code, document, markdown
from course.notebooks.merge import CannotMergeError, is_untouched, merged

STUB = "def force(k, x):\n    raise NotImplementedError"
MINE = "def force(k, x):\n    return -k * x"


def generated(*, head="# Springs", stub=STUB, extra=False):
    cells = [
        markdown(head),
        code("import math", role="setup", exercise="springs"),
        markdown("## Force"),
        code(stub, role="solution", exercise="springs", task="force"),
        code("%course_check springs force", role="check", exercise="springs", task="force"),
    ]
    if extra:
        cells.insert(3, markdown("### A hint"))
        cells.append(markdown("## What next"))
    return document(cells, kind="exercise", id="springs", version="1")


def changed(data, change):
    notebook = json.loads(data)
    change(notebook["cells"])
    return json.dumps(notebook).encode()


def worked(data):
    """Written in, run, a cell of one's own added, a copy of a cell made."""

    def work(cells):
        cells[3]["source"] = MINE
        cells[3]["execution_count"] = 7
        cells[4]["outputs"] = [{"output_type": "stream", "name": "stdout", "text": "passed"}]
        cells.insert(2, {"cell_type": "code", "id": "own", "source": "x = 1", "metadata": {}, "outputs": []})
        cells.append(copy.deepcopy(cells[4]) | {"id": "copied"})

    return changed(data, work)


def sources(data):
    return ["".join(cell["source"]) for cell in json.loads(data)["cells"]]


def test_the_same_notebook_again_changes_nothing():
    old = worked(generated())
    assert merged(old, generated()) is old
    assert merged(generated(), generated()) == generated()


def test_newer_text_is_put_around_somebodys_work():
    new = generated(head="# Springs, again", extra=True)
    after = merged(worked(generated()), new)
    assert sources(after) == [
        "# Springs, again", "import math", "x = 1", "## Force", "### A hint", MINE,
        "%course_check springs force", MINE, "## What next",
    ]  # fmt: skip
    cells = json.loads(after)["cells"]
    assert cells[5]["execution_count"] == 7
    assert cells[6]["outputs"][0]["text"] == "passed"
    assert len({cell["id"] for cell in cells}) == len(cells)
    assert merged(after, new) is after


def test_what_nobody_edited_becomes_what_it_is_now():
    new = generated(stub=STUB.replace("raise", "raise  # later:"))
    assert merged(generated(), new) == new
    ran = changed(generated(), lambda cells: cells[3].update(execution_count=1))
    assert "later" in sources(merged(ran, new))[3]


def test_a_function_that_was_written_stays_alone_where_the_course_changed_its_docstring():
    new = generated(stub=STUB.replace("raise", '"""Newer words."""\n    raise'))
    cells = sources(merged(worked(generated()), new))
    assert [text for text in cells if text.startswith("def force")] == [MINE, MINE], "and the copy"
    assert merged(merged(worked(generated()), new), new) == merged(worked(generated()), new)


def test_a_text_that_both_changed_is_there_twice():
    old = changed(generated(), lambda cells: cells[0].update(source="# My springs"))
    assert sources(merged(old, generated(head="# Springs!")))[:2] == ["# Springs!", "# My springs"]
    assert sources(merged(old, generated()))[0] == "# My springs"


@pytest.mark.parametrize(
    ("old", "why"),
    [
        (worked(generated()), "changed the parameters of a function that you wrote"),
        (changed(worked(generated()), lambda cells: cells.reverse()), "another order"),
        (document([], kind="lesson", id="springs", version="1"), "does not say that it is this notebook"),
        (b"not a notebook", "cannot be read"),
        (b"[]", "format 4"),
        (b'{"nbformat": 3, "metadata": {}, "worksheets": []}', "format 4"),
        (b'{"nbformat": 4, "metadata": {}, "cells": []}', "does not say"),
    ],
)
def test_where_it_is_not_safe_nothing_is_merged_and_the_reason_given(old, why):
    with pytest.raises(CannotMergeError, match=why):
        merged(old, generated(stub=STUB.replace("(k, x)", "(x, k)")))


def test_a_cell_the_course_no_longer_has_goes_unless_somebody_wrote_in_it():
    old = generated(extra=True)
    assert sources(merged(old, generated())) == sources(generated())
    mine = changed(old, lambda cells: cells[3].update(source="### My hint"))
    assert sources(merged(mine, generated()))[3] == "### My hint"


def test_untouched_means_generated_and_at_most_run():
    ran = changed(generated(), lambda cells: cells[3].update(execution_count=1, outputs=[]))
    own = changed(generated(), lambda cells: cells.append({"cell_type": "raw", "source": "", "metadata": {}}))
    assert is_untouched(generated())
    assert is_untouched(ran)
    assert not is_untouched(worked(generated()))
    assert not is_untouched(own)
    assert not is_untouched(b"{}")


def test_somebodys_code_means_the_same_after_a_merge(solved, integrators):
    newer = document(
        [markdown("# A new head"), *exercise_cells(integrators, stub_of(integrators))],
        kind="exercise", id="integrators", version="2",
    )  # fmt: skip
    # As it was generated for this student, and then filled in.
    given = document(
        exercise_cells(integrators, stub_of(integrators)), kind="exercise", id="integrators", version="1"
    )
    texts = {
        cell["metadata"]["course"]["task"]: cell["source"]
        for cell in json.loads(solved)["cells"]
        if cell["metadata"]["course"]["role"] == "solution"
    }

    def fill(cells):
        for cell in cells:
            if cell["metadata"]["course"]["role"] == "solution":
                cell["source"] = texts[cell["metadata"]["course"]["task"]]

    old = changed(given, fill)
    after = merged(old, newer)
    assert sources(after)[0] == "# A new head"
    assert notebook_source(after, integrators).source == notebook_source(old, integrators).source


def stub_of(exercise):
    return exercise.stub_path.read_text(encoding="utf-8")
