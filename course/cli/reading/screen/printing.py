"""A lesson's blocks as rows of a given width, and below a task how far its student is with it.

It looks like the printed lesson, except that predictions hide what follows them, cells show their results
here, and links can be followed.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import msgspec
from rich.console import Console, Group, RenderableType
from rich.segment import Segment
from rich.style import Style
from rich.table import Table
from rich.text import Text

from course.catalog import blocks as b
from course.catalog.load import Catalog
from course.cli.frame.console import STATUS_STYLE
from course.cli.frame.pictures import Code
from course.cli.reading.lesson import KEEP, FancyPrinter
from course.cli.reading.screen.running import Practice, Standing
from course.cli.work.verdict import line_of, unread_line
from course.reading.parts import Cell, Question
from course.reading.record import InProgress, Prediction, Row
from course.scoring.verdict import CheckResult, numbers_of

#: Prose is this wide at most; a cell's two outputs stand side by side where both fit.
COLUMN = 80
_BESIDE = 2 * 58 + 3

#: How right a reader was, in words.
_JUDGED = {"right": "right", "nearly": "nearly right", "wrong": "wrong"}
#: Lines of a run that are put beside a prediction.
_MOST = 6
#: Lines of what a student's code printed: there is more to see on a screen than these.
_PRINTED = 4

#: Rows at the head of a block, below the blank one, that stay together: the rule, the title and two
#: lines of a task; the label of a passage and two lines.
_LEAD = {b.Task: 6, b.Callout: 4}
#: Stands for the answer to an open prediction.
_CLOSED = Text("After your prediction the answer is shown here.", style="dim italic")


@dataclass(frozen=True, slots=True)
class BlockRows:
    """A block laid out: its lines, and facts about each."""

    lines: tuple[tuple[Segment, ...], ...] = ()
    rows: tuple[Row, ...] = ()


class ScreenPrinter(FancyPrinter):
    """Lays out one lesson in progress.

    Args:
        progress: the lesson, with what its reader did.
        practice: how far the student is with warm-ups and exercises.
        width: of the screen, in columns.
        in_colour: whether colours may be shown.
        busy: the key of the cell that runs, with what to say of it; empty if none does.
        picture: the lines for a figure, or for a task and the curve of its failed check, at a width: blank
            while they are being drawn, none if it stays described.
    """

    def __init__(
        self,
        catalog: Catalog,
        progress: InProgress,
        practice: Practice,
        width: int,
        in_colour: bool,
        busy: Callable[[], tuple[str, str]],
        picture: Callable[[str, dict[str, Any] | None, int], list[Text]],
    ) -> None:
        self._width = max(20, width - 2)
        # Kept away from the terminal: what it lays out goes to the page.
        console = Console(
            width=min(self._width, COLUMN),
            force_terminal=True,
            markup=False,
            emoji=False,
            highlight=False,
            no_color=not in_colour,
            color_system="truecolor" if in_colour else None,
        )
        super().__init__(catalog, progress.script, console)
        self._progress, self._script, self._practice = progress, progress.script, practice
        self._busy, self._picture = busy, picture
        self._index, self._links = -1, 0

    @property
    def wide(self) -> bool:
        """Two outputs fit beside each other."""
        return self._width >= _BESIDE + 4

    def draw_ahead(self) -> None:
        """Have every figure of the lesson drawn, so that it is there when its reader is."""
        for figure in self._figure_ids:
            self._picture(figure, None, self._room)

    def rows(self, index: int) -> BlockRows:
        """One block as it is now, -1 for the head of the lesson, behind the last for what stands below.

        There are no rows if it is not shown.
        """
        self._index, self._links = index, 0
        if index < 0:
            head = ((*[Text("")] * above, shown) for shown, above in self._head())
            return self._laid_out(Group(*(piece for pieces in head for piece in pieces)), -1)
        if index == len(self._script.blocks):
            return self._tail_rows()
        question = self._progress.closed_by(index)
        shown = self._closed(index, question) if question else self._block(self._script.blocks[index])
        return self._laid_out(shown, index) if shown is not None else BlockRows()

    def _tail_rows(self) -> BlockRows:
        lesson, ids = self._lesson, self._catalog.lesson_ids()
        following = ids[ids.index(lesson.id) + 1 :][:1] if lesson.id in ids else ()
        links = [(f"exercise:{name}", f"Practise: {name}") for name in lesson.exercises]
        titles = ((name, self._catalog.lesson(name).title) for name in following)
        links += [(f"lesson:{name}", f"Next lesson: {title}") for name, title in titles]
        shown = [Text("─" * 20, style="dim"), Text("You have read this lesson.", style="bold")]
        count = sum(self._progress.prediction(one) is None for one in self._script.questions)
        if count:
            are = "s are" if count != 1 else " is"
            shown.append(Text(f"{count} prediction{are} still open: t shows where."))
        tasks = [one for one in self._script.blocks if isinstance(one, b.Task) and one.what != "exercise"]
        left = sum(not self._practice.of(one.id).done for one in tasks) if self._practice.possible else 0
        if left:
            shown.append(Text(f"{left} warm-up{'s are' if left != 1 else ' is'} left: t shows where."))
        linked = [self._link(target, (b.Text(words),)) for target, words in links]
        made = self._laid_out(Group(*shown, Text(""), *linked), -1)
        rows = (Row(self._index, row.blank, number > 0) for number, row in enumerate(made.rows))
        return BlockRows(made.lines, tuple(rows))

    # -- rows ------------------------------------------------------------------------------------------

    def _laid_out(self, shown: RenderableType, index: int) -> BlockRows:
        block = self._script.blocks[index] if index >= 0 else None
        wide = self.wide and isinstance(block, b.CodeCell)
        options = self._console.options.update(width=_BESIDE if wide else self._room, height=None)
        drawn = self._console.render_lines(shown, options, pad=False)
        lines = [[self._segment(text, style) for text, style, _ in line] for line in drawn]
        lines = [[], *lines] if index >= 0 else lines
        kinds = b.CodeCell | b.Figure | b.Table | b.MathBlock | b.Diagram | b.Prediction | b.Heading
        whole = isinstance(block, kinds)
        lead = next((most for kind, most in _LEAD.items() if isinstance(block, kind)), 2)
        # A heading is not left alone at the foot of a screen, nor what stands for a closed answer on its own.
        after_head = index > 0 and isinstance(self._script.blocks[index - 1], b.Heading)
        with_above = after_head or shown is _CLOSED
        # Whether it comes right after what an open prediction closes.
        before = (one for one in self._script.questions if self._script.after(one) == index)
        afresh = any(self._progress.prediction(one) is None for one in before)
        rows = []
        for number, line in enumerate(lines):
            blank = not any(segment.text.strip() for segment in line)
            first = number <= lead or number == len(lines) - 1  # nor is a single line of a paragraph
            joined = (number > 0 and (whole or first)) or with_above
            rows.append(Row(index, blank, joined, number == 0 and afresh))
        return BlockRows(tuple(tuple(line) for line in lines), tuple(rows))

    def _segment(self, text: str, style: Style | None) -> Segment:
        if style is not None and self._console.no_color:
            style = style.without_color
        return Segment(text.replace(KEEP, " "), style)

    # -- what the screen shows otherwise ------------------------------------------------------------------

    def _closed(self, index: int, question: Question) -> RenderableType | None:
        """A block that an open prediction keeps closed."""
        block = self._script.blocks[index]
        if isinstance(block, b.CodeCell):
            return None if block.hidden else self._code(block)
        if not self._script.gives_away(index):
            return self._block(block)
        return _CLOSED if index == question.end - 1 else None

    def _block(self, block: b.Block) -> RenderableType | None:
        return self._task(block) if isinstance(block, b.Task) else super()._block(block)

    def _task(self, task: b.Task) -> RenderableType:
        """A warm-up or an exercise: its text, and how far the student is with it."""
        now = self._practice.of(task.id)
        done = ", done" if now.done else ""
        shown: list[RenderableType] = [self._rule(f"{task.what}{done}"), Text(task.title, style="bold")]
        for block in task.blocks:
            made = self._block(block)
            shown += [Text(""), made] if made is not None else []
        standing = _standing_lines(now, task.id, possible=self._practice.possible)
        shown.append(Text(""))
        if not now.busy and (curves := (now.reply or {}).get("curves")):
            # The first curve of the last check, drawn where there are pictures, and in words.
            words = Text(curves[0]["description"], style="dim")
            shown += [*self._picture(task.id, curves[0], self._room), words, Text("")]
        # The finding comes last: it is what must be in sight.
        return Group(*shown, *standing, self._rule(""))

    def _passage(self, kind: str, inner: tuple[b.Block, ...]) -> RenderableType:
        if kind == "predict":
            question = self._script.question_at(self._index)
            if question is not None:
                return self._asked(question, inner)
        shown = super()._passage(kind, inner)
        answers = self._progress.answered_at(self._index) if kind == "answer" else None
        return Group(self._compared(*answers), Text(""), shown) if answers is not None else shown

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

    def _compared(self, question: Question, said: Prediction) -> RenderableType:
        facts = [("You said", said.text)]
        for cell in self._script.shown_cells:
            if question.index < cell.index < question.end:
                state = self._progress.cell(cell)
                ours = state.printed if state.ran is not None and not state.error else ""
                gave = (ours or cell.output or "").strip("\n").splitlines()
                if len(gave) > _MOST:  # any of the last lines may hold the answer
                    gave = ["…", *gave[1 - _MOST :]]
                if gave:
                    facts.append(("Your run" if ours else "The run", "\n".join(gave)))
        judged = ("You were", _JUDGED[said.judged]) if said.judged else None
        facts.append(judged or ("Were you right?", "1 right   2 nearly   3 wrong"))
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
        shown: list[RenderableType] = [self._rule(f"Python, cell {cell.number}{changed}"), Code(state.source)]
        busy, words = self._busy()
        if busy == cell.key:
            shown.append(self._rule(words))
        elif self._progress.closed_by(self._index) is None:
            shown += self._outputs(cell)
        return Group(*shown, self._rule(""))

    def _outputs(self, cell: Cell) -> list[RenderableType]:
        state = self._progress.cell(cell)
        recorded = cell.output or ""
        if state.ran is None:
            return [self._rule("prints"), Text(recorded)] if recorded else []
        took = f"{state.seconds:.1f} s" if state.seconds >= 0.05 else f"{1000 * state.seconds:.0f} ms"
        if not state.error and state.printed == recorded and state.ran == cell.source:
            label = f"ran here in {took}: prints the same" if recorded else f"ran here in {took}"
            return [self._rule(label), *([Text(recorded)] if recorded else [])]
        stale = ", before the last change" if state.ran != state.source else ""
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
        caption = self._caption(figure)
        seen = Text.assemble(("The figure shows: ", "bold"), figure.alt, style="dim")
        picture = self._picture(figure.id, None, self._room)
        if not picture:
            return Group(caption, seen)
        if not any(picture):
            # Its place, with the description until it is drawn.
            words = seen.wrap(self._console, self._room)[: len(picture)]
            picture = [*words, *picture[len(words) :]]
        return Group(*picture, caption)

    def _link(self, target: str, children: b.Inlines) -> Text:
        self._links += 1
        text = self._text(children)
        text.stylize(Style(underline=True))
        text.stylize(Style(meta={"link": self._links, "target": target}))
        return text


# ---
# A student's progress with a warm-up or an exercise, in lines below its text.


def _standing_lines(now: Standing, name: str, *, possible: bool) -> Iterator[Text]:
    """The next step, or the last check's result: the first fault, and how many there are.

    Args:
        name: its id.
        possible: there is a workspace to work in.
    """
    if not possible:
        yield Text.assemble(("$ ", "dim"), ("course init my-course", "bold cyan"), "   makes a place for it")
        return
    if not now.file:
        yield Text.assemble(("Enter", "bold"), " puts its file into your workspace")
        return
    yield Text.assemble(("Your file: ", "bold"), now.file)
    if now.busy:
        yield Text(f"{now.busy} …", style="dim")
    elif now.reply is None and now.done:
        yield Text("Done: every check passed.", style="bold green")
    elif now.reply is None:
        yield Text.assemble(
            ("e", "bold"), " changes it here, or save it in your own editor; ", ("r", "bold"), " checks it"
        )
    else:
        if now.fixed:
            yield Text.assemble(("Fixed: ", "bold green"), ", ".join(now.fixed))
        yield from _said(now.reply, f"course hint {name} or h: a hint" if hint_is_named(now) else "")
    if now.hint:
        yield Text(now.hint, style="italic")


def hint_is_named(now: Standing) -> bool:
    """Whether the last check named a hint as the next step: one is due."""
    return _step(now.reply or {}).startswith("course hint")


def line_to_mend(now: Standing, source: str) -> int:
    """The line that the first finding of the last check is about; the first line before one."""
    reply = now.reply or {}
    if "error" in reply:
        return unread_line(source)
    _, first = _checks(reply)
    return line_of(source, first) if first is not None else 1


def _checks(reply: dict[str, Any]) -> tuple[tuple[CheckResult, ...], CheckResult | None]:
    """The checks of a reply, and the first that did not pass; what is not written yet is the last of them."""
    checks = msgspec.convert(reply.get("checks", ()), tuple[CheckResult, ...])
    left = sorted((check for check in checks if check.status != "pass"), key=lambda one: one.unwritten)
    return checks, left[0] if left else None


def _said(reply: dict[str, Any], offer: str) -> Iterator[Text]:
    if "error" in reply:
        yield Text(reply["error"]["message"], style="red")
        yield Text(reply["error"].get("help", ""))
        return
    checks, first = _checks(reply)
    yield from _printed("Loading your file printed:", reply.get("printed"))
    if first is None:
        yield Text("Done: every check passes.", style="bold green")
        step = _step(reply)
        if step.startswith("course report"):
            yield Text.assemble(("$ ", "dim"), (step, "bold cyan"), "   shows what has changed")
        return
    word, style = str(first.status).upper(), STATUS_STYLE.get(str(first.status), "red")
    if first.unwritten:
        word, style = "to do", "yellow"
    yield Text.assemble((f"{word}: ", style), (first.title, "bold"))
    for text in (first.message, first.help):
        if text and not (first.unwritten and text is first.message):
            yield Text(text)
    for label, text in numbers_of(first):
        yield Text(f"{label}: {text}", style="dim")
    yield from _printed("Your code printed:", first.stdout)
    passing = sum(check.status == "pass" for check in checks)
    some = f"{passing} of {len(checks)} checks pass.  " if len(checks) > 1 else ""
    if some or offer:
        yield Text(f"{some}{offer}".rstrip(), style="dim")


def _step(reply: dict[str, Any]) -> str:
    """The command that the reply names as the next."""
    return str((reply.get("next") or {}).get("command", ""))


def _printed(heading: str, text: str | None) -> Iterator[Text]:
    lines = (text or "").rstrip().splitlines()
    if lines:
        yield Text(heading, style="bold")
        yield from (Text(f"  {line}") for line in lines[:_PRINTED])
    if len(lines) > _PRINTED:
        yield Text("  … `course check --verbose` shows all", style="dim")
