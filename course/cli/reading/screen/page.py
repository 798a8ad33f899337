"""The one widget of the reader: a lesson in progress, laid out for the screen and shown page by page.

Above the text stands a head line, below it a position bar and a line of keys.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING, Any, ClassVar

from rich.cells import cell_len, set_cell_size
from rich.segment import Segment
from rich.style import Style
from rich.text import Text
from textual.geometry import Size
from textual.strip import Strip
from textual.timer import Timer
from textual.widget import Widget

from course.catalog import blocks as b
from course.catalog.load import Catalog
from course.cli.reading.screen.printing import BlockRows, ScreenPrinter
from course.cli.reading.screen.running import Bench, Drawer, Practice
from course.errors import CourseError
from course.full_screen import FullScreenApp, fitting, shortened
from course.progress.history import lesson_events
from course.progress.store import Event
from course.progress.workspace import Workspace
from course.reading.parts import Cell, read_script
from course.reading.record import InProgress, Layout, Place, Row, Writer

if TYPE_CHECKING:  # it needs NumPy, and no first page waits for that
    from course.reading.cells import CellOutput

#: Lines around the text: a head, a position bar and a line of keys; below this height no head.
_LOW = 16
_MARGIN, _WIDEST = 2, 80
_BAR = Style(reverse=True)
_DIM = Style(dim=True)
_HERE = Style(bold=True)
_LINK_HERE = Style(reverse=True)
#: A place is recorded once the reader has stayed there this long, in s.
_SETTLED = 1.0
#: The rest of a lesson is laid out this long after its first screen, in s.
_REST = 0.02
#: So long is waited for the word that a prediction is recorded, in s.
_PATIENCE = 0.5
_SAID = 2  # rows of what stands below a lesson: a rule, and that it was read
_ALL_KEYS = "? keys"
#: The keys where nothing else is at hand.
KEYS = "Space on   t contents   / search   ? keys   q leave"


@dataclass(frozen=True, slots=True)
class Item:
    """Something on the page that keys act on. What they do to it is said by each kind of item.

    Attributes:
        block: index of the block.
        row: within its block; in a book, within that.
        target: where a link leads; the id of a figure or a task.
        number: tells the links of a block apart, from 1; 0 for what is a block of its own.
        at_once: a click acts on it, not only chooses it.
        offered: keys act on it by default.
        hint: the keys that matter while it is at hand.
    """

    block: int
    row: int
    target: str = ""
    number: int = 0
    at_once: ClassVar[bool] = False
    offered: ClassVar[bool] = False
    hint: ClassVar[str] = KEYS

    @property
    def inline(self) -> bool:
        """It stands within a line: a link."""
        return self.number > 0

    def same(self, other: Item) -> bool:
        """Whether it is this one, laid out at another time."""
        return (type(self), self.block, self.number) == (type(other), other.block, other.number)

    def is_offered(self, page: Page) -> bool:
        """Whether keys act on it by default, as it stands now."""
        del page
        return self.offered

    def seen(self, page: Page) -> None:
        """Be ready for its keys: it came into sight."""

    def tick(self, page: Page) -> None:
        """Look what became of it, from time to time while it is in sight."""

    def keys(self, page: Page) -> str:
        """The keys that matter, as it stands now."""
        del page
        return self.hint

    def act(self, page: Page) -> None:
        """Do what Enter does here."""
        page.forward()


#: The items of a block, by the lesson, the block's index, and its lines.
ItemsOf = Callable[[InProgress, int, Sequence[Sequence[Segment]]], list[Item]]


class Book:
    """Every block of a lesson laid out for one width; blocks are laid out anew one at a time.

    Args:
        lay_out: a block's rows and items, by its index: -1 for the head, ``count`` for what stands below.
        count: of blocks.
    """

    def __init__(self, lay_out: Callable[[int], tuple[BlockRows, list[Item]]], count: int) -> None:
        self._lay_out = lay_out
        self._count = count
        self._blocks: dict[int, tuple[BlockRows, list[Item]]] = {}
        self.lines: list[Sequence[Segment]] = []
        self.items: list[Item] = []
        self.layout = Layout((), 1)
        self.whole = False

    def build(self, height: int, first: int = -1, enough: int | None = None) -> None:
        """Lay out the missing blocks, and cut them into screens.

        Args:
            height: lines of text on a screen.
            first: block to begin with, for a first look.
            enough: stop once there are this many lines.
        """
        order = range(-1, self._count + 1) if enough is None else range(first, self._count + 1)
        self.lines, self.items = [], []
        rows: list[Row] = []
        for index in order:
            if index not in self._blocks:
                self._blocks[index] = self._lay_out(index)
            made, items = self._blocks[index]
            self.items += [replace(item, row=len(rows) + item.row) for item in items]
            self.lines += made.lines
            rows += made.rows
            if enough is not None and len(rows) >= enough:
                break
        self.whole = enough is None
        self.layout = Layout(rows, height)

    def forget(self, *indices: int) -> None:
        """Lay these blocks out anew with the next build; all of them if none is named."""
        for index in indices or tuple(self._blocks):
            self._blocks.pop(index, None)

    def last_word(self) -> int:
        """The row below the line that says that the lesson was read, which stands below its last block."""
        tail = self.layout.span(self._count)
        return len(self.layout) if tail is None else min(len(self.layout), tail[0] + _SAID)


class Page(Widget):
    """A lesson in progress. Keys and the mouse are the app's business, their acts that of the items.

    Args:
        reader: the app, which shows messages.
        workspace: the student's; None outside of one.
        pictures: draws figures for this terminal; None to describe them.
        items_of: finds the items of a block.
        keys_of: the keys that matter on a page.

    Attributes:
        practice: the warm-ups and exercises in the workspace.
        progress: the lesson that is open.
        book: it as laid out.
        top: the first row on the screen.
        item: what keys act on.
        paged: a block that would be cut at the foot is left for the next screen.
        bench: where its cells run; None until one is in sight.
        trail: where links were followed from.
    """

    DEFAULT_CSS = "Page { width: 100%; height: 100%; }"
    ALLOW_SELECT = False
    can_focus = True

    def __init__(
        self,
        reader: FullScreenApp,
        catalog: Catalog,
        workspace: Workspace | None,
        pictures: Drawer | None,
        items_of: ItemsOf,
        keys_of: Callable[[Page], str],
    ) -> None:
        super().__init__()
        self.reader, self.catalog, self.pictures = reader, catalog, pictures
        self.practice = Practice(catalog, workspace)
        self._store = workspace.store if workspace is not None else None
        self._write = Writer(self._store)
        self._warned = False  # that something was not recorded
        self._unread = ""  # why the record could not be read
        self._items_of, self._keys_of = items_of, keys_of
        self.progress: InProgress
        self.book = Book(lambda _: (BlockRows(), []), 0)  # nothing, until a lesson is open
        self.top = 0
        self.item: Item | None = None
        self.paged = True
        self.bench: Bench | None = None
        self.trail: list[tuple[str, Place]] = []
        self.laid_for: Size | None = None
        self._width = 0
        self._opened: dict[str, InProgress] = {}
        self._place_timer: Timer | None = None
        self._head, self._keys, self._position, self._share, self._told = "", "", "", 0.0, ""
        # What another thread asks for is queued. No thread waits for it: who leaves may wait for that thread.
        self.practice.changed = partial(reader.call_later, self.show_answer)
        if pictures is not None:
            pictures.drawn = partial(reader.call_later, self._take_picture)

    # -- the record --------------------------------------------------------------------------------------

    @property
    def trouble(self) -> str:
        """Why something was not recorded, or could not be read; empty if all was."""
        return self._write.trouble or self._unread

    def kept(self) -> str:
        """Whether what was added to the record last is in it, for its reader."""
        if self._write.kept(_PATIENCE):
            return "Kept."
        self._warned = bool(self._write.trouble)
        return "Not kept: q says why." if self._warned else "Not kept yet." if self._store else "Not kept."

    def _events(self, lesson_id: str) -> Sequence[Event]:
        try:
            return lesson_events(self._store, lesson_id, self.catalog.syllabus.split)
        except CourseError as error:
            self._unread = self._unread or f"{error.message} {error.help}"
            return ()

    def close(self) -> None:
        """End what is checked, and wait until everything is written; not in the app's own thread."""
        self.practice.close()
        self._write.close()

    # -- opening a lesson --------------------------------------------------------------------------------

    def in_progress(self, lesson_id: str) -> InProgress:
        """A lesson, its warm-ups and exercises in their places, with what its reader did."""
        if lesson_id in self._opened:
            return self._opened[lesson_id]
        script = read_script(self.catalog.lesson(lesson_id), self.catalog.tasks(lesson_id))
        return InProgress(script, self._events(lesson_id), self._write, self.catalog.version)

    def is_read(self, lesson_id: str) -> bool:
        """Whether the end of a lesson was reached once."""
        opened = self._opened.get(lesson_id)
        return opened.read if opened is not None else any(e.kind == "lesson" for e in self._events(lesson_id))

    def open(self, lesson_id: str, place: Place | None = None, section: str = "") -> None:
        """Open a lesson at a place, at a section by its slug, or where its reader left it.

        A cell that runs in another lesson is ended.
        """
        if self._opened and lesson_id != self.progress.script.lesson.id:
            self.end_cells()
            self.keep_place()
        self.progress = self._opened[lesson_id] = self.in_progress(lesson_id)
        starts = {one.slug: one.start for one in reversed(self.progress.script.sections)}
        if place is None and section in starts:
            place = Place(starts[section])
        self.lay_out(place or self.progress.place)

    def leave_trail(self) -> None:
        """Remember where a link is followed from."""
        self.trail.append((self.progress.script.lesson.id, self.place() or Place()))

    # -- laying it out -----------------------------------------------------------------------------------

    def reflow(self) -> None:
        """Fit a window of another size; the line at the top stays."""
        # Asked for only now: keys may have come between the change and this.
        place = self.place()
        if place is not None and self.app.size != self.laid_for:
            self.lay_out(place)

    def lay_out(self, place: Place) -> None:
        """All blocks anew for this width, the place on the screen."""
        self.laid_for = self.app.size
        self._width = self.laid_for.width
        printer = ScreenPrinter(
            self.catalog,
            self.progress,
            self.practice,
            self._width,
            self.reader.in_colour,
            lambda: self.bench.busy() if self.bench is not None else ("", ""),
            self._picture,
        )
        count = len(self.progress.script.blocks)

        def laid_out(index: int) -> tuple[BlockRows, list[Item]]:
            made = printer.rows(index)
            return made, self._items_of(self.progress, index, made.lines) if made.rows else []

        book = self.book = Book(laid_out, count)
        # The first screen at once; the rest of the lesson a moment later.
        book.build(self.room, max(-1, place.block), enough=2 * self.room)
        self.show(book.layout.row(place))
        self.set_timer(_REST, lambda: self._finish(book, printer, place))

    def _finish(self, book: Book, printer: ScreenPrinter, place: Place) -> None:
        if self.book is not book or book.whole:
            return
        book.build(self.room)
        at = book.layout.row(place)
        printer.draw_ahead()
        # A lesson that is opened for the first time begins at a screen; a stored place is restored to the
        # line.
        self.show(at)

    def rebuild(self, *indices: int) -> None:
        """Lay out these blocks again; the line at the top stays."""
        book, item, place = self.book, self.item, self.place()
        rows, end = len(book.layout), self.end()
        below = bool(indices) and end > 0 and min(indices) > book.layout.rows[end - 1].block
        book.forget(*indices)
        book.build(self.room)
        self.item = next((one for one in book.items if item is not None and one.same(item)), None)
        if place is not None:
            # Not cut into screens anew where something in sight grew. A figure that is drawn does not grow.
            paged = self.paged and (below or len(book.layout) == rows)
            self.go(book.layout.row(place), paged=paged)
        self.settle(choose=self.item is None)

    def _picture(self, name: str, curve: dict[str, Any] | None, width: int) -> list[Text]:
        return self.pictures.rows(name, curve, width, self.room) if self.pictures is not None else []

    def _take_picture(self, name: str) -> None:
        for index, block in enumerate(self.progress.script.blocks):
            if any(isinstance(one, b.Figure | b.Task) and one.id == name for one in b.walk_blocks((block,))):
                self.rebuild(index)

    # -- the place ---------------------------------------------------------------------------------------

    def show(self, top: int) -> None:
        """Show the screen that begins with a row, to a reader who goes on."""
        self.reader.hush()
        self.item = None
        self.go(top)
        self.settle()

    def forward(self) -> None:
        """The next screen; at the end, what is next."""
        following = self.book.layout.next(self.top)
        if self.end() < len(self.book.layout) and following > self.top:
            asked = self._asked()
            self.show(following)
            if asked - self._asked():
                self.reader.say("You passed an open prediction.   b back to it")
        elif tail := [item for item in self.items() if item.block == len(self.progress.script.blocks)]:
            self.item = tail[-1]
            self.reader.say("This is the end. Enter: go on")

    def _asked(self) -> set[str]:
        """The open predictions on this screen."""
        found = (self.progress.asked_by(item.block) for item in self.items())
        return {question.key for question in found if question is not None}

    def go(self, top: int, *, paged: bool = True) -> None:
        """Show the screen that begins with a row; ``paged`` leaves a block that would be cut for later."""
        self.top = max(0, min(top, len(self.book.layout) - 1))
        self.paged = paged
        self.refresh()

    def settle(self, *, choose: bool = True) -> None:
        """After every move: the item that keys act on, the words around the page, the place, the end."""
        items, book = self.items(), self.book
        if choose and self.item not in items:
            self.item = next((item for item in items if item.is_offered(self)), None)
        if book.whole and self.end() >= book.last_word():
            self.progress.reached_end()
        self.say_round()
        if self._place_timer is not None:
            self._place_timer.stop()
        self._place_timer = self.set_timer(_SETTLED, self.keep_place)
        for item in items:
            item.seen(self)

    def keep_place(self) -> None:
        place = self.place()
        if place is None:
            return
        count = len(self.progress.script.blocks)
        last = self.book.layout.rows[self.end() - 1].block if self.end() else -1
        kept = place if place.block < count else Place(count - 1, 1.0)
        self.progress.at(kept, min(last, count - 1))

    def bring_to_sight(self, block: int) -> None:
        """Show the end of a block, where its output is, unless the reader has moved on."""
        span = self.book.layout.span(block)
        if span is not None and span[0] < self.end() < span[1] and self.top < span[1]:
            self.go(max(0, span[1] - self.room), paged=False)
            self.settle()

    # -- what goes on beside it --------------------------------------------------------------------------

    @property
    def running(self) -> Cell | None:
        return self.bench.cell if self.bench is not None else None

    def at_bench(self) -> Bench:
        """Where this lesson's cells run."""
        if self.bench is None:
            self.bench = Bench(self.progress, partial(self.reader.call_later, self._took, self.progress))
        return self.bench

    def end_cells(self) -> None:
        """Stop the cell that runs, and end the cells' process."""
        if self.bench is not None:
            self.bench.close()
            self.bench = None

    def _took(self, progress: InProgress, cell: Cell, source: str, gave: CellOutput) -> None:
        progress.ran(cell, source, gave.printed, gave.error, gave.seconds)
        if progress is self.progress:
            question = next((q for q in progress.script.questions if q.index < cell.index < q.end), None)
            answer = [question.answer] if question is not None and question.answer is not None else []
            self.rebuild(cell.index, *answer)
            self.bring_to_sight(cell.index)
            if gave.earlier:
                ran = ", ".join(map(str, gave.earlier))
                self.reader.say(f"Cell{'s' if len(gave.earlier) > 1 else ''} {ran} ran first.")
            self.say_round()

    def show_task(self, name: str) -> None:
        """A task in its place, as it stands now."""
        index = self.progress.script.task(name)
        if isinstance(self.progress.script.blocks[index], b.Task):
            self.rebuild(index)
            self.bring_to_sight(index)
            self.say_round()

    def show_answer(self, name: str) -> None:
        """The result of a task's check, or its hint, has arrived."""
        self.reader.hush()
        self.show_task(name)

    # -- what is on the screen ---------------------------------------------------------------------------

    @property
    def room(self) -> int:
        """Lines of text on the screen."""
        # The app knows its size before this widget is given its own.
        return max(1, self.app.size.height - 2 - self._lead)

    @property
    def _lead(self) -> int:
        return 0 if self.app.size.height < _LOW else 1

    def end(self) -> int:
        """The row after the last one on the screen."""
        layout = self.book.layout
        return layout.end_of(self.top) if self.paged else min(len(layout), self.top + self.room)

    def place(self) -> Place | None:
        """Where the reader is, in the text."""
        return self.book.layout.place(self.top) if len(self.book.layout) else None

    def item_at(self, x: int, y: int) -> Item | None:
        """The item at a cell of the screen: a link by its letters, the rest by its rows."""
        row = self.top + y - self._lead
        if not self.top <= row < self.end():
            return None
        block = self.book.layout.rows[row].block
        number = self.screen.get_style_at(x, y).meta.get("link", 0)
        return next((one for one in self.book.items if (one.block, one.number) == (block, number)), None)

    def items(self) -> list[Item]:
        """The items on this screen, from top to bottom."""
        top, end, layout = self.top, self.end(), self.book.layout

        def visible(item: Item) -> bool:
            if item.inline:
                return top <= item.row < end
            # A long cell is still at hand when its first line is above the screen.
            span = layout.span(item.block)
            return span is not None and span[0] < end and span[1] > top + 1

        return [item for item in self.book.items if visible(item)]

    # -- drawing -----------------------------------------------------------------------------------------

    def say_round(self) -> None:
        """Say where the reader is in the line above the text, and the keys, or a message, in the last one."""
        book, script = self.book, self.progress.script
        place = self.place() or Place()
        section = script.section_of(place.block) if place.block >= 0 else None
        title = script.lesson.title.partition(":")[0] if section else script.lesson.title
        head = f"{title} · {section.title}" if section else title
        if place.block < 0:  # the title itself is on the page
            known = self.catalog.lesson_ids()
            head = f"Lesson {known.index(script.lesson.id) + 1} of {len(known)}"
        room = self._width - 2
        self._told = self.reader.message
        self._head = shortened(head, room)
        keys = fitting(self._keys_of(self), room, more=_ALL_KEYS)
        self._keys = shortened(self._told, room) if self._told else keys
        self._position, self._share = "", 0.0
        if book.whole:  # which screen of how many, and the minutes left
            layout, end = book.layout, self.end()
            self._share = end / max(1, len(layout))
            minutes = max(1, round(script.minutes_left((layout.rows[end - 1].block if end else 0) + 1)))
            number, left = layout.number(self.top), f"{minutes} min left"
            if end >= len(layout):
                number, left = len(layout.starts), "the end"
            self._position = f"{number} of {len(layout.starts)} · {left}"
        self.refresh()

    def tick(self) -> None:
        """From time to time: a message goes, a cell runs on, a task was saved in an editor."""
        if self.reader.message != self._told:
            self.say_round()
        if self._write.trouble and not self._warned:
            self._warned = True
            self.reader.say("What you do now is not recorded; q leaves and says why.")
        if self.running is not None:
            self.rebuild(self.running.index)
        # A file that is saved during a check is checked after it.
        if self.practice.possible and not self.practice.busy and len(self.app.screen_stack) == 1:
            for item in self.items():
                item.tick(self)

    def render_line(self, y: int) -> Strip:
        width, height = self.size
        if y == height - 1:
            return _bar(self._keys, width)
        if y == height - 2:
            return self._position_bar(width)
        if y < self._lead:
            return _bar(self._head, width)
        row = self.top + y - self._lead
        if row >= self.end():
            return Strip.blank(width)
        item, block = self.item, self.book.layout.rows[row].block
        at_hand = item is not None and not item.inline and row == max(item.row, self.top)
        left = max(_MARGIN, (width - _WIDEST) // 2)  # the text stands in the middle of a wide window
        pieces = [Segment(" " * (left - 2) + ("▸ " if at_hand else "  "), _HERE)]
        for text, style, _ in self.book.lines[row]:
            link = style.meta.get("link", 0) if style is not None else 0
            chosen = item is not None and item.inline and item.block == block and link == item.number
            pieces.append(Segment(text, (style or Style()) + _LINK_HERE if chosen else style))
        return Strip(pieces).adjust_cell_length(width)

    def _position_bar(self, width: int) -> Strip:
        text = f" {self._position}"
        room = width - cell_len(text) - 3
        if room < 8:
            return Strip([Segment(set_cell_size(text, width), _DIM)], width)
        done = round(room * self._share)
        bars = [Segment("━" * done, _HERE), Segment("─" * (room - done), _DIM)]
        return Strip([Segment("  "), *bars, Segment(text + " ", _DIM)]).adjust_cell_length(width)


def _bar(text: str, width: int) -> Strip:
    return Strip([Segment(set_cell_size(f" {text}", width), _BAR)], width)
