"""Every lesson of the course: complete, true to its own code, and its commands do what they say."""

from __future__ import annotations

import os
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

from course.authoring.lessons.cells import run_lesson
from course.authoring.lessons.lint import findings
from course.catalog import blocks as b
from course.catalog.load import Catalog
from course.catalog.locate import content
from course.catalog.markdown import read_blocks
from course.figures.registry import figure_ids

ROOT = Path(__file__).resolve().parents[2]
CATALOG = Catalog(content())
LESSONS = CATALOG.lesson_ids()


def blocks_of(lesson_id: str) -> tuple[b.Block, ...]:
    return read_blocks(Path(CATALOG.lesson(lesson_id).path))


@pytest.mark.parametrize("lesson_id", LESSONS)
def test_a_lesson_has_all_its_parts_and_points_at_things_that_exist(lesson_id: str) -> None:
    found = findings(
        blocks_of(lesson_id),
        figures=figure_ids(),
        lessons=LESSONS,
        exercises=CATALOG.exercise_ids(),
    )
    assert not found


@pytest.mark.parametrize("lesson_id", LESSONS)
def test_every_cell_prints_what_is_recorded_and_every_number_is_what_its_code_gives(lesson_id: str) -> None:
    run = run_lesson(Path(CATALOG.lesson(lesson_id).path))
    assert run.cells
    assert run.values
    assert not [(cell.cell.line, cell.printed) for cell in run.cells if not cell.agrees]
    assert not [
        (value.value.line, value.value.text, value.computed) for value in run.values if not value.agrees
    ]


@pytest.mark.parametrize("lesson_id", LESSONS)
def test_every_command_to_try_works_in_a_fresh_workspace(lesson_id: str, tmp_path: Path) -> None:
    lists = [block for block in b.walk_blocks(blocks_of(lesson_id)) if isinstance(block, b.CommandList)]
    commands = [command.command for block in lists for command in block.commands]
    for command in ["course init .", *commands]:
        program, *words = shlex.split(command)
        assert program == "course"
        done = subprocess.run(
            [sys.executable, "-m", "course", *words],
            cwd=tmp_path,
            capture_output=True,
            text=True,
            timeout=600,
            check=False,
            env={**os.environ, "PYTHONPATH": str(ROOT), "COLUMNS": "80"},
        )
        # 1 is what a check of an unfinished exercise ends with; everything else is a command that fails.
        assert done.returncode in (0, 1), (command, done.stdout, done.stderr)
        assert "Traceback" not in done.stderr


def test_every_figure_is_shown_in_some_lesson_or_by_a_simulation() -> None:
    shown = {
        block.id
        for lesson_id in LESSONS
        for block in b.walk_blocks(blocks_of(lesson_id))
        if isinstance(block, b.Figure)
    }
    # `course sim run --plot` draws the figures of the simulations.
    assert shown == {name for name in figure_ids() if not name.startswith("sim-")}
