"""Every lesson of the course: complete, true to its own code, and its commands do what they say."""

from __future__ import annotations

import functools
import shlex
from pathlib import Path

import pytest

from course.authoring.lessons.lint import findings
from course.catalog import blocks as b
from course.catalog.load import Catalog
from course.catalog.locate import content
from course.catalog.markdown import read_blocks
from course.cli.frame.app import run
from course.figures.registry import figure_ids

CATALOG = Catalog(content())
LESSONS = CATALOG.lesson_ids()
pytestmark = pytest.mark.usefixtures("sandboxes")


@functools.cache
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
def test_a_lesson_has_cells_to_run_and_numbers_to_compute(lesson_id: str) -> None:
    """The audit runs the cells and compares what is recorded and what is quoted."""
    blocks = blocks_of(lesson_id)
    assert any(isinstance(block, b.CodeCell) for block in b.walk_blocks(blocks))
    assert any(isinstance(inline, b.Value) for _, inline in b.walk_inlines(blocks))


@pytest.mark.parametrize("lesson_id", LESSONS)
def test_every_source_has_its_address(lesson_id: str) -> None:
    (sources,) = [block for block in blocks_of(lesson_id) if isinstance(block, b.Sources)]
    for item in sources.items:
        words = "".join(inline.text for inline in item if isinstance(inline, b.Text))
        links = [inline.target for inline in item if isinstance(inline, b.Link)]
        # What was measured for the course is found in the course.
        assert any(link.startswith("https://") for link in links) or "measured for this course" in words, (
            words
        )


@pytest.mark.parametrize("lesson_id", LESSONS)
def test_every_command_to_try_works_in_a_fresh_workspace(
    lesson_id: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """In this process: starting one for each command would cost more than most of them do."""
    lists = [block for block in b.walk_blocks(blocks_of(lesson_id)) if isinstance(block, b.CommandList)]
    commands = [command.command for block in lists for command in block.commands]
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "80")
    for command in ["course init .", *commands]:
        program, *words = shlex.split(command)
        assert program == "course"
        code = run(words)
        said = capsys.readouterr()
        # 1 is what a check of an unfinished exercise ends with; everything else is a command that fails.
        assert code in (0, 1), (command, said.out, said.err)
        assert "Traceback" not in said.err


def test_every_figure_is_shown_in_some_lesson_or_by_a_simulation() -> None:
    shown = {
        block.id
        for lesson_id in LESSONS
        for block in b.walk_blocks(blocks_of(lesson_id))
        if isinstance(block, b.Figure)
    }
    # `course sim run --plot` draws the figures of the simulations.
    assert shown == {name for name in figure_ids() if not name.startswith("sim-")}


@pytest.mark.parametrize("lesson_id", LESSONS)
def test_no_prediction_quotes_a_number_of_an_answer_above_it(lesson_id: str) -> None:
    """Both may stand on one screen, and the answer above may still be closed."""

    def quoted(block: b.Block) -> set[str]:
        return {inline.text for _, inline in b.walk_inlines((block,)) if isinstance(inline, b.Value)}

    answered: set[str] = set()
    for block in blocks_of(lesson_id):
        if isinstance(block, b.Prediction):
            assert not quoted(block) & answered
        elif isinstance(block, b.Callout) and block.kind == "answer":
            answered |= quoted(block)
