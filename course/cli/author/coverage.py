"""``course author coverage``: where the course has each part of the chapter it grew out of."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

from course.authoring.coverage import as_markdown, check_coverage, read_coverage, written_to
from course.cli.author.replies import AuthorCoverage, AuthorProblem, CoverageRow
from course.cli.frame.here import load_catalog
from course.cli.frame.registry import COMMANDS
from course.cli.frame.terminal.console import Console, current
from course.simulations.registry import SIMULATIONS

if TYPE_CHECKING:
    from pathlib import Path

    from course.authoring.coverage import Coverage
    from course.authoring.report import AuditProblem
    from course.catalog.load import Catalog

__all__ = ["counted", "coverage", "is_command", "shown"]


def coverage(
    write: Annotated[bool, typer.Option("--write", help="Write docs/coverage.md again.")] = False,
) -> int:
    """Show where the course covers each part of the chapter that it is based on.

    Lists the chapter's headings, objectives, examples, exercises and questions, each with its place in the
    course and one word on how it is covered. Exit code 1 if a part or a place is missing.
    """

    console, catalog = current(), load_catalog()
    document = read_coverage(catalog)
    problems = check_coverage(document, catalog, is_command)
    table, page = document.value, None
    if write and not problems:
        page = written_to(catalog)
        page.write_text(as_markdown(table), encoding="utf-8")
    _show_coverage(console, table, problems)
    if page:
        console.note(f"Wrote {shown(page, catalog)}.")
    _emit_coverage(console, table, problems, shown(page, catalog) if page else None)
    return 1 if problems else 0


def _show_coverage(console: Console, table: Coverage, problems: tuple[AuditProblem, ...]) -> None:
    for section in table.section:
        console.heading(section.title)
        rows = [(part.what, part.word, ", ".join(part.where)) for part in section.parts]
        console.table(("part", "word", "where"), rows)
        console.blank()
    for problem in problems:
        console.line((problem.where, "bold"))
        console.line(problem.message, indent=2)
        console.line((problem.fix, "dim"), indent=2)
    found = counted(len(problems), "problem") if problems else "none is missing"
    console.line(f"{counted(len(table.parts), 'part')}, {table.source_lines} lines: {found}.")


def _emit_coverage(
    console: Console, table: Coverage, problems: tuple[AuditProblem, ...], written: str | None
) -> None:
    parts = [
        CoverageRow(
            section=section.title,
            lines=part.lines,
            kind=section.kind,
            what=part.what,
            word=part.word,
            where=part.where,
        )
        for section in table.section
        for part in section.parts
    ]
    console.emit(
        AuthorCoverage(
            ok=not problems,
            exit_code=1 if problems else 0,
            source_lines=table.source_lines,
            parts=tuple(parts),
            written=written,
            problems=tuple(AuthorProblem(p.file, p.line, p.code, p.message, p.fix) for p in problems),
        )
    )


def is_command(words: tuple[str, ...]) -> bool:
    """Whether ``course`` followed by these words is a command.

    Simulations count as words of ``sim run``, exercises that ask for prose as one of ``reflect``.
    """
    from importlib import import_module

    entry = COMMANDS.get(words[0]) if words else None
    if words[:1] == ("reflect",) and len(words) == 2:
        catalog = load_catalog()
        return words[1] in catalog.exercise_ids() and catalog.exercise(words[1]).rubric_path.is_file()
    if entry is None or (not entry.is_group and len(words) > 1):
        return False
    if len(words) == 1:
        return True
    group = typer.main.get_group(import_module(f"course.cli.{entry.module}").app)
    if words[1] not in group.commands:
        return False
    return all(word in (*SIMULATIONS, "--all") for word in words[2:])


def shown(path: Path, catalog: Catalog) -> str:
    """A path relative to the checkout."""
    root = catalog.content.root
    return path.relative_to(root).as_posix() if path.is_relative_to(root) else str(path)


def counted(number: int, word: str) -> str:
    """A number and its noun, in the plural where it needs one."""
    return f"{number} {word}" if number == 1 else f"{number} {word}s"
