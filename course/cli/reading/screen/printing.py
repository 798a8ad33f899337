"""A lesson's blocks as rows of a given width, with the items that keys act on.

It looks like the printed lesson, except that predictions hide what follows them, cells show their results
here, and links can be followed.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal

from rich.console import Console, Group, RenderableType
from rich.segment import Segment
from rich.style import Style
from rich.table import Table
from rich.text import Text

from course.catalog import blocks as b
from course.catalog.load import Catalog
from course.cli.frame.pictures import Code
from course.cli.reading.lesson import KEEP, FancyPrinter
from course.cli.reading.screen.practice import Practice, Standing
from course.cli.reading.screen.tasks import standing_lines
from course.printable import counted
from course.reading.parts import Cell, Question
from course.reading.record import InProgress, Row

__all__ = ["BlockRows", "Item", "ScreenPrinter"]

#: Prose is this wide at most; a cell's two outputs stand side by side where both fit.
COLUMN = 80
_BESIDE = 2 * 58 + 3

#: How right a reader was, in words.
_JUDGED = {"right": "right", "nearly": "nearly right", "wrong": "wrong"}
#: Lines of a run that are put beside a prediction.
_MOST = 6
Kind = Literal["link", "cell", "question", "answer", "figure", "task"]

#: Rows at the head of a block, below the blank one, that stay together: the rule, the title and two
#: lines of a task; the label of a passage and two lines.
_LEAD = {b.Task: 6, b.Callout: 4}


@dataclass(frozen=True, slots=True)
class Item:
    """Something on the page that a key acts on.

    Attributes:
        row: within its block.
        block: index of the block.
        target: where a link leads; the id of a figure or a task.
        number: tells the links of a block apart.
    """

    kind: Kind
    block: int
    row: int
    target: str = ""
    number: int = 0


@dataclass(frozen=True, slots=True)
class BlockRows:
    """A block laid out: its lines, facts about each, and the items in them."""

    lines: tuple[tuple[Segment, ...], ...]
    rows: tuple[Row, ...]
    items: tuple[Item, ...]


class ScreenPrinter(FancyPrinter):
    """Lays out one lesson in progress.

    Args:
        progress: the lesson, with what its reader did.
        width: of the screen, in columns.
        busy: the key of the cell that runs, with what to say of it; empty if none does.
        picture: a figure's lines for a width: blank while it is being drawn, none if it stays described.
        practice: how far the student is with warm-ups and exercises; None where there is nothing to work in.
        curve: the lines of a failed check's curve, for a task, what its check said of the curve, and a width.
    """

    def __init__(
        self,
        catalog: Catalog,
        progress: InProgress,
        console: Console,
        width: int,
        busy: Callable[[], tuple[str, str]] = lambda: ("", ""),
        picture: Callable[[str, int], list[Text]] = lambda *_: [],
        practice: Practice | None = None,
        curve: Callable[[str, dict[str, Any], int], list[Text]] = lambda *_: [],
    ) -> None:
        script = progress.script
        figures = [one.id for one in b.walk_blocks(script.blocks) if isinstance(one, b.Figure)]
        super().__init__(catalog, script.lesson, console, figures, None, min(width, COLUMN), {})
        self._progress = progress
        self._script = script
        self._width = width
        self._busy = busy
        self._picture = picture
        self._practice = practice
        self._curve = curve
        self._index = -1
        self._links = 0

    @property
    def column(self) -> int:
        """Columns of prose, and of figures."""
        return self._prose

    @property
    def wide(self) -> bool:
        """Two outputs fit beside each other."""
        return self._width >= _BESIDE + 4

    def head_rows(self) -> BlockRows:
        """The title, the summary, the objectives."""
        lesson = self._lesson
        shown: list[RenderableType] = [
            Text(lesson.title, style="bold"),
            Text(f"about {counted(lesson.minutes, 'minute')}", style="dim"),
            Text(""),
            Text(lesson.summary),
            Text(""),
            Text("After this lesson you can", style="bold"),
            self._bullets([Text(objective) for objective in lesson.objectives]),
        ]
        if lesson.exercises:
            commands = ", ".join(f"course start {name}" for name in lesson.exercises)
            shown += [Text(""), Text.assemble(("Then practise: ", "bold"), (commands, "bold cyan"))]
        return self._laid_out(Group(*shown), -1)

    def rows(self, index: int) -> BlockRows:
        """One block as it is now; no rows if it is not shown."""
        self._index, self._links = index, 0
        block = self._script.blocks[index]
        question = self._progress.closed_by(index)
        shown = self._closed(index, question) if question else self._block(block)
        if shown is None:
            return BlockRows((), (), ())
        return self._laid_out(shown, index)

    def tail_rows(self, shown: RenderableType, links: list[tuple[str, str]], index: int) -> BlockRows:
        """The rows after the last block: some words, and a line for each (target, words)."""
        self._links = 0
        lines = [shown, *(self._link(target, (b.Text(words),)) for target, words in links)]
        made = self._laid_out(Group(*lines), -1)
        rows = tuple(Row(index, row.blank, number > 0) for number, row in enumerate(made.rows))
        items = tuple(Item("link", index, item.row, item.target, item.number) for item in made.items)
        return BlockRows(made.lines, rows, items)

    # -- rows ------------------------------------------------------------------------------------------

    def _laid_out(self, shown: RenderableType, index: int) -> BlockRows:
        block = self._script.blocks[index] if index >= 0 else None
        wide = self.wide and isinstance(block, b.CodeCell)
        options = self._console.options.update(width=_BESIDE if wide else self._prose, height=None)
        drawn = self._console.render_lines(shown, options, pad=False)
        lines = [[self._segment(text, style) for text, style, _ in line] for line in drawn]
        lines = [[], *lines] if index >= 0 else lines
        kinds = b.CodeCell | b.Figure | b.Table | b.MathBlock | b.Diagram | b.Prediction | b.Heading
        whole = isinstance(block, kinds)
        lead = next((most for kind, most in _LEAD.items() if isinstance(block, kind)), 2)
        after_head = index > 0 and isinstance(self._script.blocks[index - 1], b.Heading)
        rows, items = [], list(self._items(index))
        for number, line in enumerate(lines):
            blank = not any(segment.text.strip() for segment in line)
            # A heading is not left alone at the foot of a screen, nor a single line of a paragraph.
            first = 0 < number <= lead or number == len(lines) - 1
            joined = (number > 0 and (whole or first)) or after_head
            fresh = number == 0 and self._begins_afresh(index)
            rows.append(Row(index, blank, joined and not (number == 0 and not after_head), fresh))
            items += self._links_in(line, index, number)
        return BlockRows(tuple(tuple(line) for line in lines), tuple(rows), tuple(items))

    def _begins_afresh(self, index: int) -> bool:
        """Whether a block comes right after what an open prediction closes."""
        before = (one for one in self._script.questions if self._script.after(one) == index)
        return any(self._progress.prediction(one) is None for one in before)

    def _segment(self, text: str, style: Style | None) -> Segment:
        if style is not None and self._console.no_color:
            style = style.without_color
        return Segment(text.replace(KEEP, " "), style)

    def _items(self, index: int) -> list[Item]:  # noqa: PLR0911 - one return per kind
        if index < 0:
            return []
        block = self._script.blocks[index]
        if self._script.question_at(index) is not None:
            return [Item("question", index, 1)]
        closed = self._progress.closed_by(index)
        if closed is not None:
            is_shut = isinstance(block, b.CodeCell) or self._script.gives_away(index)
            return [Item("question", index, 1)] if is_shut else []
        if not isinstance(block, b.CodeCell) or not block.hidden:
            if isinstance(block, b.CodeCell):
                return [Item("cell", index, 1)]
            if isinstance(block, b.Figure | b.Task):
                return [Item("figure" if isinstance(block, b.Figure) else "task", index, 1, block.id)]
            if self._said(index) is not None:
                return [Item("answer", index, 1)]
        return []

    def _links_in(self, line: list[Segment], index: int, row: int) -> list[Item]:
        found: dict[int, Item] = {}
        for segment in line:
            meta = segment.style.meta if segment.style else {}
            if "link" in meta and meta["link"] not in found:
                found[meta["link"]] = Item("link", index, row, meta["target"], meta["link"])
        return list(found.values())

    # -- what the screen shows otherwise ------------------------------------------------------------------

    def _closed(self, index: int, question: Question) -> RenderableType | None:
        """A block that an open prediction keeps closed."""
        block = self._script.blocks[index]
        if isinstance(block, b.CodeCell):
            return None if block.hidden else self._code(block)
        if not self._script.gives_away(index):
            return self._block(block)
        if index == question.end - 1:
            words = "Predict what comes out (Enter) or skip it (s): then it is shown here."
            return Text(words, style="dim italic")
        return None

    def _block(self, block: b.Block) -> RenderableType | None:
        return self._task(block) if isinstance(block, b.Task) else super()._block(block)

    def _task(self, task: b.Task) -> RenderableType:
        """A warm-up or an exercise: its text, and how far the student is with it."""
        now = self._practice.of(task.id) if self._practice is not None else Standing()
        done = ", done" if now.done else ""
        shown: list[RenderableType] = [
            self._rule(f"{task.what}{done}"),
            Text(task.title, style="bold"),
        ]
        for block in task.blocks:
            made = self._block(block)
            shown += [Text(""), made] if made is not None else []
        possible = self._practice is not None and self._practice.possible
        standing = standing_lines(now, task.id, possible=possible)
        # The finding comes last: it is what must be in sight.
        return Group(*shown, Text(""), *self._curve_lines(now, task.id), *standing, self._rule(""))

    def _curve_lines(self, now: Standing, task: str) -> list[Text]:
        """The first curve of the last check, drawn where there are pictures, and in words."""
        curves = (now.reply or {}).get("curves") or ()
        if not curves or now.busy:
            return []
        words = Text(curves[0]["description"], style="dim")
        return [*self._curve(task, curves[0], self._prose), words, Text("")]

    def _passage(self, kind: str, inner: tuple[b.Block, ...]) -> RenderableType:
        if kind == "predict":
            question = self._script.question_at(self._index)
            if question is not None:
                return self._asked(question, inner)
        shown = super()._passage(kind, inner)
        question = self._said(self._index) if kind == "answer" else None
        return Group(self._compared(question), Text(""), shown) if question is not None else shown

    def _said(self, index: int) -> Question | None:
        """The prediction that this block answers, if the reader said something."""
        question = next((one for one in self._script.questions if one.answer == index), None)
        said = self._progress.prediction(question) if question is not None else None
        return question if said is not None and not said.skipped else None

    def _asked(self, question: Question, inner: tuple[b.Block, ...]) -> RenderableType:
        shown = super()._passage("predict", inner)
        said = self._progress.prediction(question)
        if said is None:
            line = Text.assemble(("Enter", "bold"), " to predict, ", ("s", "bold"), " to skip")
        elif said.skipped:
            line = Text("Skipped.", style="dim")
        else:
            line = Text.assemble(("You said: ", "bold"), said.text)
            if said.judged:
                line.append(f"\nYou were {_JUDGED[said.judged]}.", style="dim")
            elif question.answer is not None:
                line.append("\nYou will see below whether you were right.", style="dim")
        return Group(shown, Text(""), line)

    def _compared(self, question: Question) -> RenderableType:
        """The prediction, the run's result, and the reader's own judgement."""
        said = self._progress.prediction(question)
        assert said is not None
        facts = [("You said", said.text)]
        for cell in self._script.shown_cells:
            if question.index < cell.index < question.end:
                state = self._progress.cell(cell)
                ours = state.printed if state.ran is not None and not state.error else ""
                gave = (ours or cell.output or "").strip("\n")
                if gave:
                    facts.append(("Your run" if ours else "The run", _end_of(gave)))
        if said.judged:
            facts.append(("You were", _JUDGED[said.judged]))
        else:
            facts.append(("Were you right?", "1 right   2 nearly   3 wrong"))
        grid = Table.grid(padding=(0, 2, 0, 0))
        grid.add_column(no_wrap=True)
        grid.add_column(overflow="fold", ratio=1)
        for name, text in facts:
            grid.add_row(Text(name, style="bold"), Text(text))
        return grid

    def _code(self, block: b.CodeCell) -> RenderableType:
        cell = self._script.cell_at(self._index)
        if cell is None:
            return super()._code(block)
        state = self._progress.cell(cell)
        changed = ", changed" if state.source != cell.source else ""
        shown: list[RenderableType] = [
            self._rule(f"Python, cell {cell.number}{changed}"),
            Code(state.source),
        ]
        busy, words = self._busy()
        if busy == cell.key:
            shown.append(self._rule(words))
        elif self._progress.closed_by(self._index) is None:
            shown += self._outputs(cell)
        return Group(*shown, self._rule(""))

    def _outputs(self, cell: Cell) -> list[RenderableType]:
        """The recorded output, and the cell's result here."""
        state = self._progress.cell(cell)
        recorded = cell.output or ""
        if state.ran is None:
            return [self._rule("prints"), Text(recorded)] if recorded else []
        took = f"{state.seconds:.1f} s" if state.seconds >= 0.05 else f"{1000 * state.seconds:.0f} ms"
        if not state.error and state.printed == recorded and state.ran == cell.source:
            label = f"ran here in {took}: prints the same" if recorded else f"ran here in {took}"
            return [self._rule(label), *([Text(recorded)] if recorded else [])]
        stale = ", before the last change" if state.edited else ""
        body = [Text(state.printed)] if state.printed else []
        if state.error:
            body.append(Text(state.error, style="red"))
        yours = Group(self._rule(f"yours, {took}{stale}"), *(body or [Text("(nothing)", style="dim")]))
        if not recorded:
            return [yours]
        theirs = Group(self._rule("as recorded"), Text(recorded))
        if not self.wide:
            return [theirs, yours]
        grid = Table.grid(padding=(0, 3, 0, 0))
        grid.add_column(width=58)
        grid.add_column(width=58)
        grid.add_row(theirs, yours)
        return [grid]

    def _figure(self, figure: b.Figure) -> RenderableType:
        number = self._figure_ids.index(figure.id) + 1
        caption = Text.assemble((f"Figure {number}. ", "bold"), self._text(figure.caption))
        seen = Text.assemble(("The figure shows: ", "bold"), figure.alt, style="dim")
        picture = self._picture(figure.id, self._prose)
        if not picture:
            return Group(caption, seen)
        if not any(picture):
            # Its place, with the description until it is drawn.
            words = seen.wrap(self._console, self._prose)[: len(picture)]
            picture = [*words, *picture[len(words) :]]
        return Group(*picture, caption)

    def _link(self, target: str, children: b.Inlines) -> Text:
        self._links += 1
        text = self._text(children)
        text.stylize(Style(underline=True))
        text.stylize(Style(meta={"link": self._links, "target": target}))
        return text


def _end_of(text: str) -> str:
    """A cell's output, or its last lines where there are many: any of them may hold the answer."""
    lines = text.splitlines()
    return "\n".join(lines if len(lines) <= _MOST else ["…", *lines[1 - _MOST :]])
