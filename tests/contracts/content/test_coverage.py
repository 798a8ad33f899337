"""Nothing of the chapter is missing: the table is whole, its places exist, and its page is up to date."""

from __future__ import annotations

from course.authoring.coverage import as_markdown, check_coverage, read_coverage, written_to
from course.catalog.load import Catalog
from course.catalog.locate import content
from course.cli.author.commands import is_command

CATALOG = Catalog(content())
DOCUMENT = read_coverage(CATALOG)


def test_every_part_of_the_chapter_has_a_place_that_exists() -> None:
    assert not check_coverage(DOCUMENT, CATALOG, is_command)


def test_the_table_is_as_long_as_the_chapter() -> None:
    assert DOCUMENT.value.source_lines == 394
    # Counted in the chapter.
    counts = {section.kind: len(section.parts) for section in DOCUMENT.value.section}
    assert {kind: counts[kind] for kind in ("objective", "exercise", "question")} == {
        "objective": 5,
        "exercise": 5,
        "question": 5,
    }


def test_the_page_is_what_the_table_makes() -> None:
    assert written_to(CATALOG).read_text(encoding="utf-8") == as_markdown(DOCUMENT.value)


def test_no_two_parts_have_the_same_name() -> None:
    names = [part.what for part in DOCUMENT.value.parts]
    assert sorted(names) == sorted(set(names))
