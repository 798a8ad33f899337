"""A lesson in the full-screen reader: opened where its reader left it, laid out and shown page by page."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Mapping, Sequence
from time import perf_counter
from typing import Any, ClassVar

from rich.console import Console
from rich.text import Text
from textual.app import ComposeResult
from textual.binding import Binding
from textual.events import Resize
from textual.geometry import Size
from textual.timer import Timer

from course.catalog import blocks as b
from course.catalog.load import Catalog
from course.cli.reading.screen.drawing import Drawer
from course.cli.reading.screen.page import Book, Page, Words
from course.cli.reading.screen.practice import Practice
from course.cli.reading.screen.printing import Item, ScreenPrinter
from course.cli.reading.screen.telling import fitting, position, shortened, tail
from course.full_screen import FullScreenApp
from course.progress.store import Event
from course.reading.parts import Script, read_script
from course.reading.record import InProgress, Place

#: A place is recorded once the reader has stayed there this long, in s.
_SETTLED = 1.0
#: How often the last line and running work are looked at, in s.
_TICK = 0.25
_WHEEL = 3
_SAID = 2  # rows of what stands below a lesson: a rule, and that it was read
#: The rest of a lesson is laid out this long after its first screen, in s.
_REST = 0.02


class LessonApp(FullScreenApp):
    """One lesson after the other, on the whole screen.

    Args:
        catalog: the course.
        first: id of the lesson to open.
        section: slug of the section to open it at; where it was left if empty.
        events: what is recorded about a lesson.
        write: called with each new event: kind, subject, data.
        pictures: draws figures for this terminal; None to describe them.
        practice: the warm-ups and exercises in the student's workspace.

    Attributes:
        progress: the lesson that is open.
        page: the part of it on the screen, and the items that keys act on.
    """

    # Letters of the page beside a box would be read with it.
    CSS = "Screen { overflow: hidden; } Overlay { background: $background; }"
    BINDINGS: ClassVar[list[Any]] = [
        Binding("ctrl+q", "quit", priority=True, show=False),
        Binding("q", "quit", show=False),
        Binding("space,pagedown,f", "forward", show=False),
        Binding("b,pageup,shift+space", "backward", show=False),
        Binding("down,j", "line(1)", show=False),
        Binding("up,k", "line(-1)", show=False),
        Binding("g,home", "first", show=False),
        Binding("G,end", "last", show=False),
        Binding("tab", "item(1)", show=False, priority=True),
        Binding("shift+tab", "item(-1)", show=False, priority=True),
    ]

    def __init__(
        self,
        catalog: Catalog,
        first: str,
        section: str = "",
        *,
        events: Callable[[str], Sequence[Event]] = lambda _: (),
        write: Callable[[str, str, Mapping[str, Any]], None] = lambda *_: None,
        pictures: Drawer | None = None,
        practice: Practice | None = None,
        clock: Callable[[], float] = perf_counter,
    ) -> None:
        super().__init__(clock)
        self.catalog = catalog
        self._first, self._section = first, section
        self._events = events
        self._write = write
        self._pictures = pictures if self.in_colour else None
        self._practice = practice or Practice(catalog, None)
        self.progress: InProgress
        self.page = Page()
        self._width = 0
        self._laid_for: Size | None = None
        self._told = ""
        self._place_timer: Timer | None = None
        self._opened: dict[str, InProgress] = {}

    # -- coming and going --------------------------------------------------------------------------

    def compose(self) -> ComposeResult:
        """The page is all there is."""
        yield self.page

    def on_mount(self) -> None:
        """Start."""
        self.page.focus()
        self.set_interval(_TICK, self._tick)
        self.open_at(self._first, self._section)

    def on_unmount(self) -> None:
        """Write down the place."""
        self.keep_place()
        if self._pictures is not None:
            self._pictures.close()

    def open(self, lesson_id: str, place: Place | None = None) -> None:
        """Open a lesson where its reader left it, or at a place."""
        if self._opened and lesson_id != self.progress.script.lesson.id:
            self.keep_place()
        progress = self._opened.get(lesson_id)
        if progress is None:
            script = self._script_of(lesson_id)
            progress = InProgress(script, self._events(lesson_id), self._write, self.catalog.version)
            self._opened[lesson_id] = progress
        self.progress = progress
        self.page.book = None
        self._lay_out(place or progress.place)

    def open_at(self, lesson_id: str, slug: str) -> None:
        """Open a lesson at a section, or where its reader left it if there is no such section."""
        opened = self._opened.get(lesson_id)
        sections = (
            (opened.script if opened is not None else self._script_of(lesson_id)).sections if slug else ()
        )
        start = next((section.start for section in sections if section.slug == slug), None)
        self.open(lesson_id, None if start is None else Place(start))

    def _script_of(self, lesson_id: str) -> Script:
        """A lesson with its warm-ups and exercises in their places."""
        return read_script(self.catalog.lesson(lesson_id), self.catalog.tasks(lesson_id))

    def on_resize(self, event: Resize) -> None:
        """Reflow; the line at the top stays."""
        if self._opened and event.size != self._laid_for:
            self.call_after_refresh(self._reflow)

    def _reflow(self) -> None:
        # Asked for only now: keys may have come between the change and this.
        place = self.page.place()
        if place is not None and self.size != self._laid_for:
            self._lay_out(place)

    def _lay_out(self, place: Place) -> None:
        """All blocks anew for this width, the place on the screen."""
        self._laid_for = self.size
        width = self._width = self.size.width
        console = Console(
            width=width,
            force_terminal=True,
            markup=False,
            emoji=False,
            highlight=False,
            no_color=not self.in_colour,
            color_system="truecolor" if self.in_colour else None,
        )
        # Kept away from the terminal: what it lays out goes to the page.
        printer = ScreenPrinter(
            self.catalog,
            self.progress,
            console,
            max(20, width - 2),
            self._busy,
            self._picture,
            self._practice,
            self._curve,
        )
        script = self.progress.script
        book = Book(
            printer, len(script.blocks), lambda: tail(printer, self.catalog, self.progress, self._practice)
        )
        self.page.book = book
        # The first screen at once; the rest of the lesson a moment later.
        book.build(self.page.room, max(-1, place.block), enough=2 * self.page.room)
        self._show(book.layout.row(place))
        self.set_timer(_REST, lambda: self._finish(book, place))

    def _finish(self, book: Book, place: Place) -> None:
        if self.page.book is not book or book.whole:
            return
        book.build(self.page.room)
        at = book.layout.row(place)
        self._draw_ahead(book)
        # A lesson that is opened for the first time begins at a screen; a stored place is restored to the
        # line.
        self._show(at)

    def _draw_ahead(self, book: Book) -> None:
        """Have every figure of the lesson drawn, so that it is there when its reader is."""
        for block in b.walk_blocks(self.progress.script.blocks):
            if isinstance(block, b.Figure):
                self._picture(block.id, book.column)

    def _rebuild(self, *indices: int) -> None:
        """Lay out these blocks again; the line at the top stays."""
        book = self.page.book
        if book is None:
            return
        place, item = self.page.place(), self.page.item
        rows, end = len(book.layout), self.page.end()
        below = bool(indices) and end > 0 and min(indices) > book.layout.rows[end - 1].block
        book.forget(*indices)
        book.build(self.page.room)
        self.page.item = None
        if item is not None:
            self.page.item = next(
                (
                    one
                    for one in book.items
                    if (one.kind, one.block, one.number) == (item.kind, item.block, item.number)
                ),
                None,
            )
        if place is not None:
            # Not cut into screens anew where something in sight grew. A figure that is drawn does not grow.
            paged = self.page.paged and (below or len(book.layout) == rows)
            self.page.go(book.layout.row(place), paged=paged)
        self._settle(choose=self.page.item is None)

    def keep_place(self) -> None:
        """Write down where the reader is."""
        if not self._opened:
            return
        place, book = self.page.place(), self.page.book
        if place is None or book is None:
            return
        count = len(self.progress.script.blocks)
        last = book.layout.rows[self.page.end() - 1].block if self.page.end() else -1
        self.progress.at(
            Place(min(place.block, count - 1), place.part if place.block < count else 1.0),
            min(last, count - 1),
        )

    def action_quit_now(self) -> None:
        """Leave; the place is kept."""
        self.keep_place()
        super().action_quit_now()

    # -- showing ------------------------------------------------------------------------------------

    def _show(self, top: int, *, paged: bool = True) -> None:
        self.hush()
        self.page.item = None
        self.page.go(top, paged=paged)
        self._settle()

    def _settle(self, *, choose: bool = True) -> None:
        """After every move: the item that keys act on, the words around the page, the place, the end."""
        items = self.page.items()
        if choose and (self.page.item is None or self.page.item not in items):
            self.page.item = next((item for item in items if self._is_offered(item)), None)
        book = self.page.book
        if book is not None and book.whole and self.page.end() >= self._last_word(book):
            self.progress.reached_end()
        self._say_round()
        if self._place_timer is not None:
            self._place_timer.stop()
        self._place_timer = self.set_timer(_SETTLED, self.keep_place)

    def _last_word(self, book: Book) -> int:
        """The row below the line that says that the lesson was read, which stands below its last block."""
        tail = book.layout.span(len(self.progress.script.blocks))
        return len(book.layout) if tail is None else min(len(book.layout), tail[0] + _SAID)

    def _is_offered(self, item: Item) -> bool:
        """Whether keys act on it by default."""
        del item
        return False

    def _keys(self) -> str:
        """The keys that matter here."""
        return "Space on   q leave"

    def _busy(self) -> tuple[str, str]:
        """The key of the cell that runs and what to say of it; empty if none does."""
        return "", ""

    def _say_round(self) -> None:
        page, script = self.page, self.progress.script
        book = page.book
        if book is None:
            return
        layout = book.layout
        place = page.place() or Place()
        section = script.section_of(place.block) if place.block >= 0 else None
        title = script.lesson.title
        head = f"{title.partition(':')[0]} · {section.title}" if section else title
        if place.block < 0:  # the title itself is on the page
            known = self.catalog.lesson_ids()
            head = f"Lesson {known.index(script.lesson.id) + 1} of {len(known)}"
        share = page.end() / max(1, len(layout))
        self._told = self.message
        room = self._width - 2
        keys = shortened(self._told, room) if self._told else fitting(self._keys(), room)
        where = position(script, layout, page.top, page.end()) if book.whole else ""
        page.words = Words(shortened(head, self._width - 2), keys, where, share)
        page.refresh()

    def say(self, message: str) -> None:
        """Show something in the last line for a moment."""
        super().say(message)
        self._say_round()

    def _tick(self) -> None:
        if self.message != self._told:
            self._say_round()

    def _picture(self, figure_id: str, width: int) -> list[Text]:
        if self._pictures is None:
            return []
        return self._pictures.rows(figure_id, width, self.page.room, self._drawn)

    def _curve(self, task: str, reply: dict[str, Any], width: int) -> list[Text]:
        if self._pictures is None:
            return []
        return self._pictures.curve_rows(task, reply, width, self.page.room, self._drawn)

    def _drawn(self, name: str) -> None:
        """The picture of a figure or a task has arrived (from another thread)."""
        with contextlib.suppress(RuntimeError):  # the reader is gone
            self.call_from_thread(self._take_picture, name)

    def _take_picture(self, name: str) -> None:
        for index, block in enumerate(self.progress.script.blocks):
            if any(isinstance(one, b.Figure | b.Task) and one.id == name for one in b.walk_blocks((block,))):
                self._rebuild(index)

    # -- moving --------------------------------------------------------------------------------------

    def action_forward(self) -> None:
        """The next screen."""
        book = self.page.book
        if book is None:
            return
        following = book.layout.next(self.page.top)
        if self.page.end() < len(book.layout) and following > self.page.top:
            self._show(following)
        else:
            tail = [item for item in self.page.items() if item.block == len(self.progress.script.blocks)]
            if tail:
                self.page.item = tail[-1]
                self.say("This is the end. Enter: go on")

    def action_backward(self) -> None:
        """The screen before."""
        if self.page.book is not None:
            self._show(self.page.book.layout.previous(self.page.top))

    def action_line(self, lines: int) -> None:
        """A line on or back."""
        book = self.page.book
        if book is None:
            return
        top = max(0, min(self.page.top + lines, len(book.layout) - self.page.room))
        self.page.go(top, paged=False)
        self._settle()

    def action_first(self) -> None:
        """The first screen."""
        self._show(0)

    def action_last(self) -> None:
        """The last screen."""
        if self.page.book is not None:
            self._show(self.page.book.layout.last)

    def action_item(self, way: int) -> None:
        """The next thing on this screen that keys act on; after the last, the first of the next screen."""
        self.hush()
        items = self.page.items()
        at = items.index(self.page.item) + way if self.page.item in items else (0 if way > 0 else -1)
        if not items or at >= len(items) or (at < 0 and self.page.item in items):
            self.action_forward() if way > 0 else self.action_backward()
            items, at = self.page.items(), 0 if way > 0 else -1
        if items:
            self.page.item = items[at]
            self._say_round()

    def on_mouse_scroll_down(self) -> None:
        """Some lines on."""
        if len(self.screen_stack) == 1:
            self.action_line(_WHEEL)

    def on_mouse_scroll_up(self) -> None:
        """Some lines back."""
        if len(self.screen_stack) == 1:
            self.action_line(-_WHEEL)
