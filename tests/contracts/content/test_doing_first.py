"""Doing comes first: what a reader meets at the start of every lesson.

The limits are words as the reader counts them for the time that is left (`Script.weights`: text, code and
output). At 150 words a minute 250 words take less than two minutes, and 600 take four. A new student, timed,
mended the demo's first mistake within a minute, after 150 words, did the first warm-up in three and a half
minutes, and then read 815 words before the first question of a lesson. So: a question within two minutes, its
run right after it, and a task within four.
"""

from dataclasses import replace

import pytest

from course.catalog import blocks as b
from course.catalog.load import Catalog
from course.catalog.locate import content
from course.reading.parts import read_script

CATALOG = Catalog(content())
#: The most words before the question that the first cell answers, from it to the cell, and before a task.
MOST = {"question": 250, "run": 200, "task": 600}


def read(lesson_id):
    return read_script(CATALOG.lesson(lesson_id), CATALOG.warm_ups(lesson_id))


def too_late(script):
    """What comes too late, and after how many words."""
    cell = script.shown_cells[0].index
    asked = max(one.index for one in script.questions if one.index < cell)
    task = next(index for index, block in enumerate(script.blocks) if isinstance(block, b.Task))
    parts = {"question": slice(asked), "run": slice(asked, cell), "task": slice(task)}
    words = {name: sum(script.weights[part]) for name, part in parts.items()}
    return {name: count for name, count in words.items() if count > MOST[name]}


@pytest.mark.parametrize("lesson_id", CATALOG.lesson_ids())
def test_a_lesson_begins_with_a_question_its_run_and_a_warm_up(lesson_id):
    assert too_late(read(lesson_id)) == {}


def test_a_page_more_to_read_first_is_too_late():
    script = read(CATALOG.lesson_ids()[0])
    longer = replace(script, weights=(MOST["task"], *script.weights[1:]))
    assert list(too_late(longer)) == ["question", "task"]
