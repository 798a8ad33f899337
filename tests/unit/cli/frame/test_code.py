"""Code in a narrow window: what goes on in the next row is no statement of its own."""

from __future__ import annotations

import io
import itertools

import pytest
from rich.console import Console

from course.catalog.load import Catalog
from course.cli.frame.pictures import Code
from course.reading.parts import read_script

MARK = "↳ "
SOURCES = [
    cell.source for lesson in Catalog().lessons() for cell in read_script(lesson).cells if not cell.hidden
]


def rows_of(source: str, width: int) -> list[str]:
    console = Console(width=width, file=io.StringIO())
    console.print(Code(source))
    return console.file.getvalue().splitlines()


def indent_of(row: str) -> int:
    return len(row) - len(row.lstrip())


@pytest.mark.parametrize("width", [36, 60])
def test_a_long_line_of_a_lesson_goes_on_further_in_behind_a_sign(width: int) -> None:
    for source in SOURCES:
        rows = rows_of(source, width)
        assert max(map(len, rows)) <= width
        begun = [row for row in rows if not row.lstrip().startswith(MARK)]
        lines = source.splitlines()
        assert len(begun) == len(lines)
        assert all(line.startswith(row) for row, line in zip(begun, lines, strict=True))
        for before, row in itertools.pairwise(rows):
            if row.lstrip().startswith(MARK):
                far = indent_of(before) if MARK in before else indent_of(before) + 2
                assert indent_of(row) == far
        assert "".join("".join(row.replace(MARK, "").split()) for row in rows) == "".join(source.split())
    assert any(MARK in row for source in SOURCES for row in rows_of(source, 36)), "some are that long"


@pytest.mark.parametrize(
    ("source", "width", "rows"),
    [
        ("total = first_of_all + second_of_all", 24, ["total = first_of_all +", "  ↳ second_of_all"]),
        ("x" * 30, 24, ["x" * 24, "  ↳ " + "x" * 6]),
        ("'" + "積" * 12 + "'", 20, ["'" + "積" * 9, "  ↳ " + "積" * 3 + "'"]),
        ("if x:\n\n    return 1\n", 12, ["if x:", "", "    return 1"]),
    ],
    ids=["between words", "where it must", "letters of two columns", "as wide as the window"],
)
def test_a_line_breaks_between_words_where_it_can(source: str, width: int, rows: list[str]) -> None:
    assert rows_of(source, width) == rows
