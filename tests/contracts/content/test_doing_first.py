"""Doing comes first: what a reader meets at the start of every lesson.

The limits are words as the reader counts them for the time that is left (`Script.weights`: text, code and
output). At 150 words a minute 250 words take less than two minutes, and 600 take four. A new student, timed,
mended the demo's first mistake within a minute, after 150 words, did the first warm-up in three and a half
minutes, and then read 815 words before the first question of a lesson. So: a question within two minutes, its
run right after it, and a task within four.
"""

from dataclasses import dataclass, replace

import pytest

from course.catalog import blocks as b
from course.catalog.load import Catalog
from course.catalog.locate import content
from course.reading.parts import read_script

CATALOG = Catalog(content())
TO_THE_QUESTION, TO_ITS_RUN, TO_A_TASK = 250, 200, 600


@dataclass(frozen=True)
class Start:
    """Words before the question that the first cell answers, from it to the cell, and before a task."""

    question: int
    run: int
    task: int


def start_of(script):
    words = script.weights
    cell = script.shown_cells[0].index
    asked = max(one.index for one in script.questions if one.index < cell)
    task = next(index for index, block in enumerate(script.blocks) if isinstance(block, b.Task))
    return Start(sum(words[:asked]), sum(words[asked:cell]), sum(words[:task]))


def too_late(start):
    limits = {"question": TO_THE_QUESTION, "run": TO_ITS_RUN, "task": TO_A_TASK}
    found = {name: (getattr(start, name), limit) for name, limit in limits.items()}
    return [
        f"{name}: {words} words, at most {limit}" for name, (words, limit) in found.items() if words > limit
    ]


@pytest.mark.parametrize("lesson_id", CATALOG.lesson_ids())
def test_a_lesson_begins_with_a_question_its_run_and_a_warm_up(lesson_id):
    script = read_script(CATALOG.lesson(lesson_id), CATALOG.warm_ups(lesson_id))
    assert too_late(start_of(script)) == []


def test_a_page_more_to_read_first_is_too_late():
    lesson_id = CATALOG.lesson_ids()[0]
    script = read_script(CATALOG.lesson(lesson_id), CATALOG.warm_ups(lesson_id))
    longer = replace(script, weights=(TO_A_TASK, *script.weights[1:]))
    assert [line.split(":")[0] for line in too_late(start_of(longer))] == ["question", "task"]
