"""The audit of lessons.

The syllabus and the files agree, the heads name what exists, texts parse, links work, and every quoted or
printed number is what the lesson's own code gives.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from course.authoring.lessons.cells import run_lesson
from course.catalog.blocks import Figure, walk_blocks
from course.catalog.front_matter import split_front_matter
from course.catalog.markdown import read_blocks
from course.catalog.reading import read_text
from course.catalog.toml_lines import LineMap
from course.errors import ContentError, UsageError
from course.figures.registry import figure_ids
from course.ids import LessonId

if TYPE_CHECKING:
    from pathlib import Path

    from course.authoring.lessons.links import LinkChecker
    from course.authoring.report import Findings
    from course.catalog.blocks import Block
    from course.catalog.load import Catalog
    from course.catalog.models import Lesson

__all__ = ["audit_lesson", "audit_syllabus"]


def audit_syllabus(catalog: Catalog, findings: Findings) -> None:
    """Every lesson file is listed and every listed lesson has a file."""
    syllabus = catalog.content.syllabus
    listed = catalog.lesson_ids()
    lines = LineMap(read_text(syllabus))
    for index, lesson_id in enumerate(listed):
        if not (catalog.content.lessons / f"{lesson_id}.md").is_file():
            findings.add(
                syllabus,
                lines.line(("lessons", index)),
                "syllabus",
                f"lesson {lesson_id} has no file.",
                f"Write {lesson_id}.md beside the syllabus, or remove the line.",
            )
    for path in sorted(catalog.content.lessons.glob("*.md")):
        if path.stem not in listed:
            findings.add(
                path,
                None,
                "syllabus",
                "the syllabus does not list this lesson.",
                f'Add "{path.stem}" to `lessons` in {syllabus.name}.',
            )


def audit_lesson(catalog: Catalog, lesson_id: str, findings: Findings, links: LinkChecker) -> None:
    """One lesson: its head, its text and its links."""
    path = catalog.content.lessons / f"{lesson_id}.md"
    try:
        LessonId(lesson_id)
        lesson = catalog.read_lesson(lesson_id)
        _audit_head(catalog, path, lesson, findings)
        blocks = read_blocks(path)
        links.check_lesson(path, blocks)
        _audit_figures(path, blocks, findings)
        _audit_numbers(path, findings)
    except UsageError as error:
        findings.add(path, None, "content", error.message, error.help)
    except ContentError as error:
        findings.add_error(error)


def _audit_head(catalog: Catalog, path: Path, lesson: Lesson, findings: Findings) -> None:
    lines = LineMap(split_front_matter(read_text(path), path).toml, first_line=2)
    order = catalog.lesson_ids()
    place = order.index(lesson.id) if lesson.id in order else len(order)
    for index, earlier in enumerate(lesson.before):
        if earlier not in order[:place]:
            findings.add(
                path,
                lines.line(("before", index)),
                "lesson",
                f"lesson {earlier} does not come before this one in the syllabus.",
                "Correct the id, or change the order of the syllabus.",
            )
    for index, exercise_id in enumerate(lesson.exercises):
        if exercise_id not in catalog.exercise_ids():
            findings.add(
                path,
                lines.line(("exercises", index)),
                "lesson",
                f"there is no exercise {exercise_id}.",
                f"Known: {', '.join(catalog.exercise_ids())}.",
            )


def _audit_figures(path: Path, blocks: tuple[Block, ...], findings: Findings) -> None:
    for block in walk_blocks(blocks):
        if isinstance(block, Figure) and block.id not in figure_ids():
            findings.add(
                path,
                block.line,
                "lesson",
                f"there is no figure {block.id}.",
                f"Known: {', '.join(figure_ids())}.",
            )


def _audit_numbers(path: Path, findings: Findings) -> None:
    """Recorded output and quoted numbers agree with the cells."""
    run = run_lesson(path)
    for cell in run.cells:
        if not cell.agrees:
            findings.add(
                path,
                cell.cell.output_line or cell.cell.line,
                "lesson",
                f"the code cell prints {cell.printed!r}, and the lesson records {cell.cell.output!r}.",
                "Put what it prints into the output block below the cell.",
            )
    for quoted in run.values:
        if not quoted.agrees:
            findings.add(
                path,
                quoted.value.line,
                "lesson",
                f"the text says {quoted.value.text}, and {quoted.value.expression} gives {quoted.computed}.",
                "Correct the text, or the code if the text is right.",
            )
