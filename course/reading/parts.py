"""A lesson cut into what its reader meets: sections, predictions and what each keeps closed, cells.

A prediction closes what would answer it: everything after it up to and including its answer. Code stays in
sight without its output, since most questions are about the code below them, and so does prose that quotes
no computed number. Answered or skipped, the prediction opens all of it.

Predictions and cells are known by a digest of their own words, so that an edit elsewhere in a lesson, which
moves and renumbers them, loses no student's answers.
"""

import hashlib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import assert_never

from course.catalog import blocks as b
from course.catalog.markdown import read_blocks, read_task
from course.catalog.models import Exercise, Lesson
from course.printable import counted


@dataclass(frozen=True, slots=True)
class Section:
    """A heading and how far it reaches: the blocks from ``start`` up to ``end``, not included."""

    title: str
    level: int
    slug: str
    start: int
    end: int


@dataclass(frozen=True, slots=True)
class Question:
    """A prediction.

    Attributes:
        number: 1 for the first of the lesson.
        index: of its block.
        answer: index of the passage that answers it; None if there is none.
        end: index of the first block after it that is open again.
        key: of its answer in the record.
        words: the question.
    """

    number: int
    index: int
    answer: int | None
    end: int
    key: str
    words: str


@dataclass(frozen=True, slots=True)
class Cell:
    """A code cell.

    Attributes:
        number: 1 for the first shown cell; 0 for a hidden one.
        order: its place among all cells, hidden ones included, 0 first.
        index: of its block; for a cell inside another block, of that.
        key: of its events in the record.
        source: as the lesson has it.
        output: recorded in the lesson; None if there is none.
    """

    number: int
    order: int
    index: int
    key: str
    source: str
    output: str | None

    @property
    def hidden(self) -> bool:
        """It runs for what later cells need, and is not shown."""
        return self.number == 0


@dataclass(frozen=True)
class Script:
    """One lesson, ready to be read.

    Attributes:
        blocks: its blocks, in order; a place in the text is an index among them.
        weights: words in each block, for the time that is left.
    """

    lesson: Lesson
    blocks: tuple[b.Block, ...]
    sections: tuple[Section, ...]
    questions: tuple[Question, ...]
    cells: tuple[Cell, ...]
    weights: tuple[int, ...]

    @property
    def shown_cells(self) -> tuple[Cell, ...]:
        """The cells a reader sees."""
        return tuple(cell for cell in self.cells if not cell.hidden)

    def cell_at(self, index: int) -> Cell | None:
        """The shown cell that is this block."""
        return next((cell for cell in self.cells if cell.index == index and not cell.hidden), None)

    def question_at(self, index: int) -> Question | None:
        """The prediction that is this block."""
        return next((one for one in self.questions if one.index == index), None)

    def answered_at(self, index: int) -> Question | None:
        """The prediction that this block answers."""
        return next((one for one in self.questions if one.answer == index), None)

    def question_over(self, index: int) -> Question | None:
        """The prediction that keeps this block closed until it is answered; None if nothing does."""
        return next((one for one in self.questions if one.index < index < one.end), None)

    def after(self, question: Question) -> int:
        """Index of the first block in sight that takes the answer as read; behind the last if none does."""
        rest = range(question.end, len(self.blocks))
        return next((i for i in rest if not is_unseen(self.blocks[i])), len(self.blocks))

    def gives_away(self, index: int) -> bool:
        """Whether a block below an open prediction must not be seen: it may hold the answer."""
        match self.blocks[index]:
            case b.CodeCell() | b.MathBlock() | b.Heading():
                return False
            case b.Paragraph() as block:
                return any(isinstance(piece, b.Value) for _, piece in b.walk_inlines((block,)))
            case _:
                return True

    def task(self, name: str) -> int:
        """Index of the block where a warm-up or an exercise is done; of the last one if none is."""
        found = (i for i, block in enumerate(self.blocks) if isinstance(block, b.Task) and block.id == name)
        return next(found, len(self.blocks) - 1)

    def section_of(self, index: int) -> Section | None:
        """The section (level 2) a block stands in; None before the first."""
        return next((s for s in self.sections if s.level == 2 and s.start <= index < s.end), None)

    def section_at(self, index: int) -> Section | None:
        """The innermost section a block stands in; None before the first."""
        inside = [section for section in self.sections if section.start <= index < section.end]
        return max(inside, key=lambda section: section.level, default=None)

    def minutes_left(self, index: int) -> float:
        """Reading time from a block to the end, by words."""
        total = sum(self.weights) or 1
        return self.lesson.minutes * sum(self.weights[max(index, 0) :]) / total


def read_script(lesson: Lesson, tasks: Sequence[Exercise] = ()) -> Script:
    """Read a lesson.

    Args:
        tasks: warm-ups and exercises that are done in it, each at the end of the section that it follows, or
            of the lesson, before its sources.

    Raises:
        ContentError: it cannot be read or parsed.
    """
    blocks = with_tasks(read_blocks(Path(lesson.path)), tasks)
    return Script(
        lesson=lesson,
        blocks=blocks,
        sections=tuple(_sections(blocks)),
        questions=tuple(_questions(blocks)),
        cells=tuple(_cells(blocks)),
        weights=tuple(len(words_of(block).split()) for block in blocks),
    )


def words_of(block: b.Block) -> str:
    """Everything in a block that can be read aloud, code and formulae included."""
    parts: list[str] = []
    for inner in b.walk_blocks((block,)):
        match inner:
            case b.CodeCell(source=text, output=output, hidden=False):
                parts += [text, output or ""]
            case b.Listing(text=text) | b.MathBlock(text=text) | b.Diagram(drawing=text):
                parts.append(text)
            case b.CommandList(commands=commands):
                parts += [f"{one.command} {one.note}" for one in commands]
            case b.Figure(alt=alt, caption=caption):
                parts += [b.plain_text(caption), alt]
            case b.Heading(inlines=inlines) | b.Paragraph(inlines=inlines):
                parts.append(b.plain_text(inlines))
            case b.Table(header=header, rows=rows):
                parts += [b.plain_text(cell) for row in (header, *rows) for cell in row]
            case b.Sources(items=items):
                parts += [b.plain_text(item) for item in items]
            case b.Task(title=title, blocks=task):
                parts += [title, *map(words_of, task)]
            case b.CodeCell() | b.ListBlock() | b.Prediction() | b.Callout():
                pass  # a hidden cell; and what holds others, which come by themselves
            case _:
                assert_never(inner)
    return "\n".join(part for part in parts if part)


def with_tasks(blocks: tuple[b.Block, ...], tasks: Sequence[Exercise]) -> tuple[b.Block, ...]:
    """The blocks of a lesson with its tasks where they belong: after the section that each names."""
    sections = tuple(_sections(blocks))
    ends = {section.slug: section.end for section in sections}
    end = next((section.start for section in sections if section.slug == "sources"), len(blocks))
    placed: dict[int, list[b.Block]] = {}
    for one in tasks:
        placed.setdefault(ends.get(one.after, end), []).append(_task(one))
    return tuple(
        each
        for index in range(len(blocks) + 1)
        for each in (*placed.get(index, ()), *blocks[index : index + 1])
    )


def _task(exercise: Exercise) -> b.Task:
    """A warm-up in full. An exercise is longer than its lesson's pages: its README lies beside its file."""
    if exercise.is_warm_up:
        what = f"warm-up, {counted(exercise.minutes, 'minute')}"
        return b.Task(0, exercise.id, what, exercise.title, read_task(exercise.readme_path))
    asked = tuple((b.Paragraph(0, (b.Text(task.title),)),) for task in exercise.task)
    readme = f"{exercise.place}/{exercise.readme_path.name}"
    blocks = (
        b.Paragraph(0, (b.Text(exercise.summary),)),
        b.ListBlock(0, None, asked),
        b.Paragraph(0, (b.Text("How each is judged: "), b.Span("code", (b.Text(readme),)))),
    )
    return b.Task(0, exercise.id, "exercise", exercise.title, blocks)


def _sections(blocks: tuple[b.Block, ...]) -> Iterator[Section]:
    heads = [(index, block) for index, block in enumerate(blocks) if isinstance(block, b.Heading)]
    for index, head in heads:
        end = next((at for at, other in heads if at > index and other.level <= head.level), len(blocks))
        yield Section(b.plain_text(head.inlines), head.level, b.slug(head), index, end)


def _questions(blocks: tuple[b.Block, ...]) -> Iterator[Question]:
    number = 0
    for index, block in enumerate(blocks):
        if not isinstance(block, b.Prediction):
            continue
        number += 1
        answer, end = None, len(blocks)
        for at in range(index + 1, len(blocks)):
            below = blocks[at]
            if isinstance(below, b.Callout) and below.kind == "answer":
                answer, end = at, at + 1
                break
            if isinstance(below, b.Prediction) or (isinstance(below, b.Heading) and below.level == 2):
                end = at
                break
        words = words_of(block)
        yield Question(number, index, answer, end, _key(words), words)


def _cells(blocks: tuple[b.Block, ...]) -> Iterator[Cell]:
    number = order = 0
    for index, block in enumerate(blocks):
        for inner in b.walk_blocks((block,)):
            if isinstance(inner, b.CodeCell):
                number += not inner.hidden
                shown = 0 if inner.hidden else number
                yield Cell(shown, order, index, _key(inner.source), inner.source, inner.output)
                order += 1


def is_unseen(block: b.Block) -> bool:
    """Whether a block is a cell that only later cells need."""
    return isinstance(block, b.CodeCell) and block.hidden


def _key(words: str) -> str:
    return hashlib.sha256(words.encode()).hexdigest()[:12]
