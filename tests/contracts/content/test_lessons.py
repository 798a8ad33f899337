"""The commands of every lesson do what they say. What else a lesson must have is the audit's."""

from pathlib import Path

import pytest

from course.catalog import blocks as b
from course.catalog.load import Catalog
from course.catalog.locate import content
from course.catalog.markdown import read_blocks
from course.cli.author.trying import refused

CATALOG = Catalog(content())


@pytest.mark.parametrize("lesson_id", CATALOG.lesson_ids())
def test_every_command_to_try_works_in_a_fresh_workspace(lesson_id):
    blocks = b.walk_blocks(read_blocks(Path(CATALOG.lesson(lesson_id).path)))
    lists = [block for block in blocks if isinstance(block, b.CommandList)]
    commands = [command.command for block in lists for command in block.commands]
    assert commands
    assert refused(commands) == {}


def test_a_command_that_fails_is_named_with_what_it_said():
    assert refused(["course lessons", "course quizz", "ls", "course check integrators"]) == {
        1: "No such command 'quizz'. Did you mean 'quiz'?",
        2: "ls: it is no command of the course",
        3: "There is no file integrators/integrators.py.",
    }
