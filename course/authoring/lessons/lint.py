"""The rules for lessons beyond the format: what a lesson must have, must not have and must refer to.

The audit asks ``findings`` for every lesson; each finding names a line and the fix. Whether code cells print
what is recorded is a different question, answered by running them: ``course.authoring.lessons.cells``.
"""

from __future__ import annotations

import ast
import re
from dataclasses import dataclass
from typing import TYPE_CHECKING

from course.catalog import blocks as b

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator

__all__ = ["MAX_COLUMNS", "Finding", "findings"]

#: Code, output and drawings are never wrapped; this is what 60 columns leave beside a margin of two.
MAX_COLUMNS = 58
#: Whole numbers up to here are words ("four methods, 12 of them"), not measurements.
_SMALL = 12
#: "In 2005": a date has a source, not a computation.
_YEARS = range(1600, 2100)
_NUMBER = re.compile(r"(?<![\w.])\d[\d,]*(?:\.\d+)?(?:e[-+]?\d+)?(?![\w])")

#: Left in the text by ``[3](=a + b)``, which has spaces and is therefore not a link in Markdown.
_UNREAD_VALUE = re.compile(r"\]\(<?=")


@dataclass(frozen=True, slots=True)
class Finding:
    """Something wrong with a lesson.

    Attributes:
        line: line of the file, counted from 1; 0 when something is missing altogether.
        problem: what is wrong.
        fix: what to do about it.
    """

    line: int
    problem: str
    fix: str


def findings(
    blocks: tuple[b.Block, ...],
    *,
    figures: Collection[str],
    lessons: Collection[str],
    exercises: Collection[str],
) -> list[Finding]:
    """Everything wrong with a lesson, in the order of its lines.

    Args:
        blocks: the lesson.
        figures, lessons, exercises: the ids it may point at.
    """
    found = [
        *_missing_parts(blocks),
        *_unpredicted(blocks),
        *_dead_pointers(blocks, figures, lessons, exercises),
        *_unread_values(blocks),
        *_unproduced_numbers(blocks),
        *_too_wide(blocks),
    ]
    return sorted(found, key=lambda finding: finding.line)


def _missing_parts(blocks: tuple[b.Block, ...]) -> Iterator[Finding]:
    every = list(b.walk_blocks(blocks))
    callouts = {block.kind for block in every if isinstance(block, b.Callout)}
    for kind in ("myth", "fact", "analogy"):
        if kind not in callouts:
            yield Finding(0, f"the lesson has no {kind}", f"Add a quote: > **{kind.capitalize()}.** …")
    headings = [b.plain_text(block.inlines).lower() for block in every if isinstance(block, b.Heading)]
    for opening in ("before you start", "worked example", "try it", "what to do next"):
        if not any(heading.startswith(opening) for heading in headings):
            yield Finding(0, f"no section begins {opening!r}", f"Add one: ## {opening.capitalize()}")
    wanted = {
        b.Figure: ("figure", "Draw one in course/figures and show it: ![…](figure:id)."),
        b.CodeCell: ("code cell", "Add a ```python fence."),
        b.CommandList: ("command to try", "Add a ```console fence."),
        b.Prediction: ("prediction", "Add a quote: > **Predict.** …"),
        b.Sources: ("list of sources", "Add a section ## Sources with one source an item."),
    }
    for kind_of_block, (name, fix) in wanted.items():
        if not any(isinstance(block, kind_of_block) for block in every):
            yield Finding(0, f"the lesson has no {name}", fix)


def _unpredicted(blocks: tuple[b.Block, ...]) -> Iterator[Finding]:
    """A figure or a run with no prediction before it in its section, and predictions left unanswered."""
    asked: b.Prediction | None = None
    open_question = False
    for block in blocks:
        match block:
            case b.Heading(level=2) | b.Prediction() if open_question and asked:
                yield Finding(
                    asked.line, "a prediction that is not answered", "Add > **Answer.** … after it."
                )
            case _:
                pass
        match block:
            case b.Heading(level=2):
                asked, open_question = None, False
            case b.Prediction():
                asked, open_question = block, True
            case b.Callout(kind="answer"):
                open_question = False
            case b.Figure(line=line) if asked is None:
                yield Finding(line, "a figure without a prediction", "Put > **Predict.** … before it.")
            case b.CodeCell(line=line, output=str()) if asked is None:
                yield Finding(line, "a run without a prediction", "Put > **Predict.** … before it.")
            case _:
                pass
    if open_question and asked:
        yield Finding(asked.line, "a prediction that is not answered", "Add > **Answer.** … after it.")


def _dead_pointers(
    blocks: tuple[b.Block, ...],
    figures: Collection[str],
    lessons: Collection[str],
    exercises: Collection[str],
) -> Iterator[Finding]:
    for block in b.walk_blocks(blocks):
        if isinstance(block, b.Figure) and block.id not in figures:
            yield Finding(
                block.line, f"there is no figure {block.id!r}", "Enter it in course/figures/registry.py."
            )
    ids = {"lesson": lessons, "exercise": exercises}
    for _, inline in b.walk_inlines(blocks):
        if isinstance(inline, b.Link):
            kind, _, name = inline.target.partition("#")[0].partition(":")
            if kind in ids and name not in ids[kind]:
                yield Finding(inline.line, f"there is no {kind} {name!r}", f"Name a {kind} that exists.")


def _unread_values(blocks: tuple[b.Block, ...]) -> Iterator[Finding]:
    """Links to a value that were not parsed as links, so that a reader would see their source."""
    for block, inline in b.walk_inlines(_without_code_spans(blocks)):
        if isinstance(inline, b.Text) and _UNREAD_VALUE.search(inline.text):
            yield Finding(
                block.line,
                "a value link that Markdown does not read as one",
                "Close its brackets, and put an expression with spaces between < and >: [3](<=a + b>).",
            )


def _unproduced_numbers(blocks: tuple[b.Block, ...]) -> Iterator[Finding]:
    """Numbers in prose that no code produces: neither a value, nor a constant of a code cell.

    Mathematics, code, years, sources and alternative texts are left out; a constant of the code is what
    the author chose, and may be quoted as such.
    """
    given = {value for block in b.walk_blocks(blocks) for value in _constants(block)}
    for block, inline in b.walk_inlines(_without_code_spans(blocks)):
        if isinstance(block, b.Sources) or not isinstance(inline, b.Text):
            continue
        for match in _NUMBER.finditer(inline.text):
            number = float(match.group().replace(",", ""))
            if number in given or (number.is_integer() and (number <= _SMALL or number in _YEARS)):
                continue
            fix = f"Let code give it, [{match.group()}](=expression), or make it a constant of a code cell."
            yield Finding(block.line, f"{match.group()} is produced by no code", fix)


def _constants(block: b.Block) -> Iterator[float]:
    if not isinstance(block, b.CodeCell):
        return
    for node in ast.walk(ast.parse(block.source)):
        if isinstance(node, ast.Constant) and isinstance(node.value, int | float):
            yield float(node.value)


def _without_code_spans(blocks: tuple[b.Block, ...]) -> tuple[b.Block, ...]:
    """The prose blocks of a lesson, code spans removed."""
    prose: list[b.Block] = []
    for block in b.walk_blocks(blocks):
        match block:
            case b.Paragraph(line, inlines):
                prose.append(b.Paragraph(line, _no_code(inlines)))
            case b.Figure(line, id_, alt, caption):
                prose.append(b.Figure(line, id_, alt, _no_code(caption)))
            case b.Table(line, header, rows, align):
                clean = tuple(tuple(_no_code(cell) for cell in row) for row in rows)
                prose.append(b.Table(line, header, clean, align))
            case _:
                pass
    return tuple(prose)


def _no_code(inlines: b.Inlines) -> b.Inlines:
    return tuple(piece for piece in inlines if not (isinstance(piece, b.Span) and piece.style == "code"))


def _too_wide(blocks: tuple[b.Block, ...]) -> Iterator[Finding]:
    for block in b.walk_blocks(blocks):
        match block:
            case b.CodeCell(line, source, output, False):
                texts = [("code", line, source), ("output", block.output_line or line, output or "")]
            case b.Diagram(line, _, drawing):
                texts = [("drawing", line, drawing)]
            case b.Listing(line, text):
                texts = [("text", line, text)]
            case b.MathBlock(line, _, text):
                texts = [("formula", line, text)]
            case _:
                continue
        for kind, line, text in texts:
            widest = max((len(row) for row in text.splitlines()), default=0)
            if widest > MAX_COLUMNS:
                problem = f"{kind} {widest} columns wide"
                yield Finding(line, problem, f"Break it: 60 columns leave room for {MAX_COLUMNS}.")
