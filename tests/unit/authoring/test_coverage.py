"""The table of where the course has what: it finds what is missing, and the page says what the table says."""

import json

import pytest

from course.authoring.coverage import as_markdown, check_coverage, read_coverage, written_to
from course.catalog.load import Catalog
from course.catalog.locate import content
from course.cli.author.commands import is_command
from course.cli.frame.app import run
from course.errors import ContentError, NotFoundError
from tests.unit.authoring.conftest import edit

TABLE = """\
format_version = 1
source_lines = 7

[[section]]
title = "All of it"
kind = "heading"
parts = [
    ["1, 7", "the title", "kept", ["lesson:{lesson}"]],
    ["2-4", "the idea", "deeper", ["command:demo", "exercise:{it}"]],
    ["5", "the picture", "measured", ["figure:integrators-phase"]],
    ["6", "the loop", "corrected", ["file:lessons/syllabus.toml"]],
]
"""


@pytest.fixture
def table(mini):
    """A table of the miniature course that has nothing wrong with it."""
    catalog = Catalog(content())
    path = mini / "docs" / "coverage.toml"
    path.parent.mkdir()
    text = TABLE.format(lesson=catalog.lesson_ids()[0], it=catalog.exercise_ids()[0])
    path.write_text(text, encoding="utf-8")
    return path


def problems(path, old="", new=""):
    """What is wrong with the table after a change of it."""
    edit(path, old, new)
    catalog = Catalog(content())
    return check_coverage(read_coverage(catalog), catalog, is_command)


def test_a_table_whose_places_all_exist_is_right(table):
    assert not problems(table)


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("lesson:", "lesson:no-", "is not there"),
        ('"]', '#nowhere"]', "names none of its headings"),
        ("exercise:", "exercise:no-", "is not there"),
        ("command:demo", "command:demonstrate", "is not there"),
        ("command:demo", "command:demo now", "is not there"),
        ("command:demo", "command:author cover", "is not there"),
        ("command:demo", "command:sim run no-such-thing", "is not there"),
        ("figure:integrators-phase", "figure:none", "is not there"),
        ("file:lessons/syllabus.toml", "file:lessons/none.toml", "is not there"),
        ("file:lessons/syllabus.toml", "solution:none", "is not there"),
        ("file:lessons/syllabus.toml", "quiz:none", "is not there"),
        ("file:lessons/syllabus.toml", "page:1", "is not there"),
        ('["figure:integrators-phase"]', "[]", "has it nowhere"),
        ('"kept"', '"splendid"', "no word 'splendid'"),
        ('["5"', '["five"', "'five' are not lines"),
        ('["1, 7"', '["1; 7"', "'1; 7' are not lines"),
        ('["5"', '["4-5"', "line 4 belongs to 'the idea' already"),
        ('["5"', '["5, 7"', "line 7 belongs to 'the title' already"),
    ],
)
def test_what_is_wrong_is_said_with_its_line(table, old, new, said):
    found = problems(table, old, new)
    assert any(said in problem.message for problem in found)
    text = table.read_text(encoding="utf-8").splitlines()
    for problem in found:
        assert problem.file == "docs/coverage.toml"
        assert problem.line
        assert problem.message.split(":")[0] in text[problem.line - 1] or "of the chapter" in problem.message
        assert problem.help


def test_a_kind_that_there_is_not_is_said(table):
    (found,) = problems(table, 'kind = "heading"', 'kind = "chapter"')
    assert "no kind 'chapter'" in found.message
    assert found.line


def test_lines_of_the_chapter_that_belong_to_no_part_are_counted(table):
    (found,) = problems(table, "source_lines = 7", "source_lines = 10")
    assert "3 lines of the chapter belong to no part: 8, 9, 10." in found.message


@pytest.mark.parametrize(
    ("words", "there"),
    [
        (("sim", "run", "free-fall"), True),
        (("sim", "run", "--all"), True),
        (("quiz", "take"), True),
        (("check",), True),
        (("author",), True),
        ((), False),
        (("reflect", "sim-to-real"), True),
        (("reflect", "integrators"), False),  # asks for no prose
        (("reflect", "none"), False),
    ],
)
def test_commands_are_known_with_their_groups(words, there):
    assert is_command(words) is there


def test_a_course_without_a_table_says_where_to_look(mini):
    with pytest.raises(NotFoundError, match=r"coverage\.toml"):
        read_coverage(Catalog(content()))


def test_an_unknown_key_is_refused_with_its_line(table):
    with pytest.raises(ContentError, match=r"coverage\.toml:2"):
        problems(table, "source_lines", "lines")


def test_the_command_writes_the_page_and_answers_in_json(table, capsys):
    assert run(["author", "coverage", "--write", "--json"]) == 0
    body = json.loads(capsys.readouterr().out)
    assert (body["schema"], body["ok"], body["written"]) == (
        "course.author-coverage/1",
        True,
        "docs/coverage.md",
    )
    assert [part["what"] for part in body["parts"]] == ["the title", "the idea", "the picture", "the loop"]
    catalog = Catalog(content())
    page = written_to(catalog).read_text(encoding="utf-8")
    assert page == as_markdown(read_coverage(catalog).value)
    assert "| the idea | deeper | `course demo`, exercise [doubling]" in page
    assert body["parts"][1]["lines"] == "2-4"
    assert body["parts"][1]["kind"] == "heading"


def test_a_table_with_a_gap_exits_with_one_and_writes_nothing(table, capsys):
    table.write_text(table.read_text().replace("source_lines = 7", "source_lines = 8"))
    assert run(["author", "coverage", "--write"]) == 1
    assert "4 parts, 8 lines: 1 problem." in capsys.readouterr().out
    assert not written_to(Catalog(content())).exists()
