"""What keys act on in a lesson: a link, a prediction and its answer, a cell, a warm-up, a figure.

Each kind of item knows the keys that matter while it is at hand, and what they do.
"""

from collections.abc import Sequence
from typing import TypeVar

from rich.segment import Segment

from course.browser import opened
from course.catalog import blocks as b
from course.cli.reading.screen.asking import Edit, Predict
from course.cli.reading.screen.page import KEYS, Item, Page
from course.cli.reading.screen.printing import hint_is_named, line_to_mend
from course.cli.reading.screen.running import write_cell
from course.errors import CourseError
from course.reading.parts import Cell, Question
from course.reading.record import InProgress, Judgement, Place

_BUSY = "Something is being checked already."

Kind = TypeVar("Kind", bound=Item)


class LinkItem(Item):
    """A link, to a place in a lesson, a task, or a page of the web."""

    at_once = True

    def keys(self, page: Page) -> str:
        del page
        kind, _, rest = self.target.partition(":")
        where = f"open {rest.partition('#')[0] if kind in {'lesson', 'exercise'} else self.target}"
        if self.target.startswith("#"):
            where = f"go to {self.target[1:].replace('-', ' ')}"
        return f"Enter: {where}   Tab next   Space on"

    def act(self, page: Page) -> None:
        kind, _, rest = self.target.partition(":")
        name, _, slug = rest.partition("#")
        if kind not in {"lesson", "exercise"} and not self.target.startswith("#"):
            shown = opened(self.target)
            if not shown:  # no browser can show it here
                page.app.copy_to_clipboard(self.target)
            page.reader.say(f"Opened {self.target}" if shown else f"Copied: {self.target}")
            return
        # Where a warm-up or an exercise is done: in the lesson that leads to it.
        lesson = page.catalog.exercise(name).lesson if kind == "exercise" else ""
        page.leave_trail()
        if lesson:
            page.open(lesson, Place(page.in_progress(lesson).script.task(name)))
        else:
            page.open(name or page.progress.script.lesson.id, section=slug or self.target.partition("#")[2])
        page.reader.say("You followed a link.   Backspace back to where it was")


class QuestionItem(Item):
    """A prediction, or the first of what an open one keeps closed."""

    at_once = True

    def is_offered(self, page: Page) -> bool:
        return page.progress.asked_by(self.block) is not None

    def keys(self, page: Page) -> str:
        return "Enter predict   s skip   ? keys" if self.is_offered(page) else KEYS

    def act(self, page: Page) -> None:
        question = page.progress.asked_by(self.block)
        if question is None:
            page.forward()
            return

        def said(text: str | None) -> None:
            if text:
                answer(page, question, text)

        page.app.push_screen(Predict(question.words), said)


def answer(page: Page, question: Question, text: str) -> None:
    """Open an answer after a prediction; a skip is kept, too, as an empty one."""
    page.progress.predict(question, text)
    script = page.progress.script
    page.rebuild(*range(question.index, question.end), script.after(question), len(script.blocks))
    page.item = None
    page.settle()
    cells = [c for c in script.shown_cells if question.index < c.index < question.end]
    run = " r: run" if cells else ""
    page.reader.say(f"{page.kept() if text else 'Skipped.'} The answer is open.{run}")


class AnswerItem(Item):
    """The answer to a prediction that its reader made."""

    hint = "were you 1 right, 2 nearly, 3 wrong   Space on"

    def is_offered(self, page: Page) -> bool:
        answers = page.progress.answered_at(self.block)
        return answers is not None and answers[1].judged is None

    def judge(self, page: Page, judged: Judgement) -> None:
        """How good the prediction was, in the reader's own judgement."""
        question = page.progress.script.answered_at(self.block)
        if question is not None:
            page.progress.judge(question, judged)
            page.rebuild(question.index, self.block)


class CellItem(Item):
    offered = True
    hint = "r run   e change   u undo   c copy   w write   Space on   ? keys"

    def seen(self, page: Page) -> None:
        """Its process starts ahead."""
        page.at_bench().prepare()

    def run(self, page: Page) -> None:
        """Run it, and before it what it needs."""
        if page.at_bench().start(self._cell(page)):
            page.rebuild(self.block)
        else:
            page.reader.say("A cell is running; Ctrl-C stops it.")

    act = run

    def edit(self, page: Page) -> None:
        cell = self._cell(page)
        progress = page.progress

        def keep(source: str) -> None:
            if source != before:
                progress.edit(cell, source.rstrip("\n"))

        def done(run: bool | None) -> None:
            if run is not None:
                page.rebuild(self.block)
            if run:
                self.run(page)

        before = progress.cell(cell).source
        page.app.push_screen(Edit(f"Cell {cell.number}", before, keep, "run"), done)

    def undo(self, page: Page) -> None:
        cell = self._cell(page)
        page.progress.edit(cell, cell.source)
        page.rebuild(self.block)
        page.reader.say("The lesson's own code is back.")

    def copy(self, page: Page) -> None:
        cell = self._cell(page)
        page.app.copy_to_clipboard(page.progress.cell(cell).source + "\n")
        page.reader.say(f"Cell {cell.number} is copied, if your terminal allows it; w writes a file.")

    def write(self, page: Page) -> None:
        """Write it into a file of the current folder."""
        try:
            page.reader.say(f"Wrote {write_cell(page.progress, self._cell(page))}")
        except CourseError as error:
            page.reader.say(error.message)

    def _cell(self, page: Page) -> Cell:
        cell = page.progress.script.cell_at(self.block)
        assert cell is not None
        return cell


def cell_at_hand(page: Page) -> CellItem | None:
    """The chosen cell, or the first in sight; the reader is told if there is none."""
    item = in_sight(page, CellItem) or _cell_ahead(page)
    if item is not None:
        page.item = item
        return item
    question = page.progress.asked_by(page.item.block) if page.item is not None else None
    page.reader.say("Predict first: Enter, or s to skip." if question else "No cell in sight.")
    return None


def in_sight(page: Page, kind: type[Kind]) -> Kind | None:
    """The item of a kind that is at hand, or the first in sight."""
    return next((one for one in (page.item, *page.items()) if isinstance(one, kind)), None)


def _cell_ahead(page: Page) -> CellItem | None:
    """The cell of the last prediction on the screen, where its answer is open but it is further down."""
    for item in reversed(page.items()):
        question = page.progress.script.question_at(item.block) if isinstance(item, QuestionItem) else None
        if question is None or page.progress.prediction(question) is None:
            continue
        for found in page.book.items:
            if isinstance(found, CellItem) and question.index < found.block < question.end:
                page.show(page.book.layout.row(Place(found.block)))
                return found
    return None


class TaskItem(Item):
    """A warm-up or an exercise: started, changed and checked in its place. Each save is checked."""

    def is_offered(self, page: Page) -> bool:
        return not page.practice.of(self.target).done

    def keys(self, page: Page) -> str:
        now = page.practice.of(self.target)
        if not page.practice.possible:
            return "done in a workspace   Space on   ? keys"
        if not now.file:
            return "Enter start it   Space on   ? keys"
        if now.busy:  # in a low window its own line may be out of sight
            return f"{now.busy} ...   Space on   ? keys"
        hint = "h hint   " if hint_is_named(now) else ""
        return f"r check   e edit   {hint}Space on   ? keys"

    def tick(self, page: Page) -> None:
        """Check it where the student saved it in an editor."""
        if page.practice.was_saved(self.target):
            page.practice.ask(self.target, "check")
            page.rebuild(self.block)

    def run(self, page: Page) -> None:
        """Start it, or check it."""
        practice = page.practice
        if not practice.possible:
            page.reader.say("Make a workspace first: course init my-course")
        elif practice.of(self.target).file:
            if not practice.ask(self.target, "check"):
                page.reader.say(_BUSY)
        else:
            try:
                practice.start(self.target)
            except CourseError as error:
                page.reader.say(error.message)
        page.show_task(self.target)

    act = run

    def ask_hint(self, page: Page) -> None:
        if not page.practice.of(self.target).file:
            self.run(page)
        elif page.practice.ask(self.target, "hint"):
            page.show_task(self.target)
        else:
            page.reader.say(_BUSY)

    def edit(self, page: Page) -> None:
        """Change its file here; a missing one is written first."""
        practice = page.practice
        if not practice.of(self.target).file:
            self.run(page)
            if not practice.of(self.target).file:
                return

        def keep(source: str) -> None:
            if told := practice.write(self.target, source):
                page.reader.say(told)

        def done(check: bool | None) -> None:
            if check:
                practice.ask(self.target, "check")
            if check is not None:
                page.rebuild(self.block)

        now = practice.of(self.target)
        try:
            source = practice.source(self.target)
        except OSError as error:
            page.reader.say(f"{now.file} cannot be read: {error.strerror}.")
            return
        page.app.push_screen(Edit(now.file, source, keep, "check", line_to_mend(now, source)), done)


class FigureItem(Item):
    hint = "Enter or o: open the figure   Space on   ? keys"

    def act(self, page: Page) -> None:
        """Open it in the system's viewer."""
        if page.pictures is None:
            lesson = page.progress.script.lesson.id
            page.reader.say(f"course lesson {lesson} --figures DIR writes the pictures.")
            return
        page.reader.say("Drawing the figure …")
        page.pictures.open(self.target, lambda words: page.reader.call_later(page.reader.say, words))


def unjudged(page: Page) -> AnswerItem | None:
    """The first answer in sight whose prediction is not judged yet."""
    answers = (one for one in page.items() if isinstance(one, AnswerItem))
    return next((one for one in answers if one.is_offered(page)), None)


def keys_of(page: Page) -> str:
    """The keys that matter on a page now."""
    item = page.item
    if page.running is not None and not isinstance(item, TaskItem):
        return "the cell runs   Ctrl-C stop it"
    keys = item.keys(page) if item is not None else KEYS
    # The answer's own keys say it.
    if page.running is not None or isinstance(item, AnswerItem) or unjudged(page) is None:
        return keys
    return f"1 right, 2 nearly, 3 wrong   {keys}"


def items_of(progress: InProgress, index: int, lines: Sequence[Sequence[Segment]]) -> list[Item]:
    """What keys act on in a block of a lesson: the block itself, if they do, and the links in its lines."""
    kind = _kind_of(progress, index) if 0 <= index < len(progress.script.blocks) else None
    items: list[Item] = []
    if kind is not None:
        block = progress.script.blocks[index]
        target = block.id if isinstance(block, b.Figure | b.Task) and kind is not QuestionItem else ""
        items.append(kind(index, 1, target))
    for row, line in enumerate(lines):
        metas = (segment.style.meta for segment in line if segment.style)
        links = {meta["link"]: meta["target"] for meta in metas if "link" in meta}
        items += [LinkItem(index, row, target, number) for number, target in links.items()]
    return items


def _kind_of(progress: InProgress, index: int) -> type[Item] | None:
    """What a block itself is to the keys."""
    script, block = progress.script, progress.script.blocks[index]
    if script.question_at(index) is not None:
        return QuestionItem
    if progress.closed_by(index) is not None:
        return QuestionItem if isinstance(block, b.CodeCell) or script.gives_away(index) else None
    match block:
        case b.CodeCell():
            return None if block.hidden else CellItem
        case b.Figure():
            return FigureItem
        case b.Task():
            return TaskItem
        case _:
            return AnswerItem if progress.answered_at(index) is not None else None
