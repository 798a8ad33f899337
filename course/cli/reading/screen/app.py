"""The program behind the reader: what keys and the mouse do, and a lesson after the other."""

from __future__ import annotations

import asyncio
import contextlib
import os
import signal
from functools import partial
from time import perf_counter
from typing import TYPE_CHECKING, Any, ClassVar

from rich.console import Console, Group
from rich.text import Text
from textual.app import App
from textual.binding import Binding

from course.cli.reading.screen.page import Book, Page, Words
from course.cli.reading.screen.printing import BlockRows, Item, ScreenPrinter
from course.cli.reading.screen.running import Bench
from course.errors import CourseError
from course.reading.pages import Place
from course.reading.parts import read_script
from course.reading.record import InProgress

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from textual.app import ComposeResult

    from course.catalog.load import Catalog
    from course.progress.store import Event
    from course.reading.cells import Gave
    from course.reading.parts import Cell, Question

__all__ = ["ReaderApp"]

#: A place is written down once the reader stays there this long, in s.
_SETTLED = 1.0
#: How often the time a cell has taken is shown anew, in s.
_TICK = 0.25
#: How long a message stays in the last line, in s.
_MESSAGE = 4.0
_WHEEL = 3
#: The rest of a lesson is laid out this long after its first screen, in s.
_REST = 0.02
_SHORT_OF = "…"
_JUDGED = {"1": "right", "2": "nearly", "3": "wrong"}

_HELP = (
    ("Space, PgDn", "next screen; at the end of the lesson: what is next"),
    ("b, PgUp", "the screen before"),
    ("↓ ↑, j k, the wheel", "a line on or back"),
    ("g G, Home End", "the first screen, the last"),
    ("Tab, Shift-Tab", "the next thing that keys act on: a prediction, a cell, a figure, a link"),
    ("Enter", "predict; run the cell; open the figure; follow the link"),
    ("s", "skip a prediction; that is kept, too"),
    ("1 2 3", "below an answer: you were right, nearly right, wrong"),
    ("r", "run the cell, and before it what it needs"),
    ("Ctrl-C", "stop the cell that runs; else leave. Your place is kept"),
    ("e", "change the cell; Ctrl-R there runs it"),
    ("u", "the lesson's own code again"),
    ("c", "copy the cell, or a command, to the clipboard of your terminal"),
    ("w", "write the cell into a file here"),
    ("o", "open the figure in the system's viewer"),
    ("t", "contents, with what is done"),
    ("/", "search in this lesson and in all"),
    ("n", "the next place where the words are"),
    ("Backspace", "back to where a link was followed"),
    ("q", "leave; `course lesson` comes back to this line"),
)


class ReaderApp(App[None]):
    """One lesson after the other, on the whole screen.

    Args:
        catalog: the course.
        first: id of the lesson to open.
        events: what is recorded about a lesson.
        write: called with each new event: kind, subject, data.
        pictures: draws figures for this terminal; None to describe them.

    Attributes:
        failure: what went wrong inside; raised again by ``view.read`` once the terminal is clean.
        progress: the lesson that is open.
    """

    CSS = "Screen { overflow: hidden; }"
    ENABLE_COMMAND_PALETTE = False

    BINDINGS: ClassVar[list[Any]] = [
        Binding("ctrl+c", "stop", priority=True, show=False),
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
        Binding("enter", "act", show=False),
        Binding("s", "skip", show=False),
        Binding("1", "judge('1')", show=False),
        Binding("2", "judge('2')", show=False),
        Binding("3", "judge('3')", show=False),
        Binding("r", "run_cell", show=False),
        Binding("e", "edit", show=False),
        Binding("u", "undo", show=False),
        Binding("c", "copy", show=False),
        Binding("w", "write_cell", show=False),
        Binding("o", "open_figure", show=False),
        Binding("t", "contents", show=False),
        Binding("slash", "search", show=False),
        Binding("n", "next_hit", show=False),
        Binding("backspace,left", "return", show=False),
        Binding("question_mark,f1,h", "help", show=False),
    ]

    def __init__(
        self,
        catalog: Catalog,
        first: str,
        *,
        events: Callable[[str], Sequence[Event]] = lambda _: (),
        write: Callable[[str, str, Mapping[str, Any]], None] = lambda *_: None,
        pictures: Any = None,
        clock: Callable[[], float] = perf_counter,
    ) -> None:
        # Without colour the terminal's own colours stay, rather than shades of grey.
        self.in_colour = not os.environ.get("NO_COLOR")
        if self.in_colour:
            super().__init__()
        else:
            super().__init__(ansi_color=True)
        self.catalog = catalog
        self.failure: BaseException | None = None
        self._first = first
        self._events = events
        self._write = write
        self._pictures = pictures if self.in_colour else None
        self._clock = clock
        self.progress: InProgress
        self.page = Page()
        self._width = 0
        self._laid_for: Any = None
        self._trail: list[tuple[str, Place]] = []
        self._message = ("", 0.0)
        self._wanted = ""
        self._bench: Bench | None = None
        self._place_timer: Any = None
        self._opened: dict[str, InProgress] = {}

    # -- coming and going --------------------------------------------------------------------------

    def compose(self) -> ComposeResult:
        """The page is all there is."""
        yield self.page

    def on_mount(self) -> None:
        """Start."""
        loop = asyncio.get_running_loop()
        for name in ("SIGINT", "SIGTERM", "SIGHUP"):
            # A closed window or a plain kill leaves the terminal as clean as a key does, and keeps the place.
            with contextlib.suppress(NotImplementedError, AttributeError, RuntimeError, ValueError):
                loop.add_signal_handler(getattr(signal, name), self.action_quit_now)
        self.page.focus()
        self.set_interval(_TICK, self._tick)
        self.open(self._first)

    def on_unmount(self) -> None:
        """Write down the place, and end what runs."""
        self.keep_place()
        self._end_cells()
        if self._pictures is not None:
            self._pictures.close()

    def _handle_exception(self, error: Exception) -> None:
        # Whoever opened the reader reports errors; a picture of the stack would be a second report.
        if self.failure is None:
            self.failure = error
        if self.is_headless:
            super()._handle_exception(error)
        else:
            self._return_code = 1
            self._close_messages_no_wait()

    def open(self, lesson_id: str, place: Place | None = None) -> None:
        """Open a lesson where its reader left it, or at a place."""
        if self._opened and lesson_id != self.progress.script.lesson.id:
            self.keep_place()
            self._end_cells()
        progress = self._opened.get(lesson_id)
        if progress is None:
            script = read_script(self.catalog.lesson(lesson_id))
            progress = InProgress(script, self._events(lesson_id), self._write, self.catalog.version)
            self._opened[lesson_id] = progress
        self.progress = progress
        self.page.book = None
        self._lay_out(place or progress.place)

    def on_resize(self, event: Any) -> None:
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
            self.catalog, self.progress, console, max(20, width - 2), self._busy, self._picture
        )
        script = self.progress.script
        book = Book(printer, len(script.blocks), lambda: self._tail(printer))
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
        # Whoever opens a lesson anew sees its screens as they are cut; a kept place is kept to the line.
        self._show(at)

    def _draw_ahead(self, book: Book) -> None:
        """Have every figure of the lesson drawn, so that it is there when its reader is."""
        from course.catalog import blocks as b

        for block in b.walk_blocks(self.progress.script.blocks):
            if isinstance(block, b.Figure):
                self._picture(block.id, book.column)

    def _rebuild(self, *indices: int) -> None:
        """These blocks anew; the line at the top stays."""
        book = self.page.book
        if book is None:
            return
        place, item = self.page.place(), self.page.item
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
            # Not cut into screens anew: what was in sight stays, whatever grew.
            self.page.go(book.layout.row(place), paged=False)
        self._settle(choose=self.page.item is None)

    def keep_place(self) -> None:
        """Write down where the reader is."""
        if not self._opened:
            return
        place, book = self.page.place(), self.page.book
        if place is None or book is None or not book.whole:
            return
        count = len(self.progress.script.blocks)
        last = book.layout.rows[self.page.end() - 1].block if self.page.end() else -1
        self.progress.at(
            Place(min(place.block, count - 1), place.part if place.block < count else 1.0),
            min(last, count - 1),
        )

    # -- showing ------------------------------------------------------------------------------------

    def _show(self, top: int, *, paged: bool = True) -> None:
        self.page.item = None
        self.page.go(top, paged=paged)
        self._settle()

    def _settle(self, *, choose: bool = True) -> None:
        """After every move: what keys act on, the words round the page, the place, the end."""
        items = self.page.items()
        if choose and (self.page.item is None or self.page.item not in items):
            self.page.item = next((item for item in items if self._is_offered(item)), None)
        if any(item.kind == "cell" for item in items):
            self._at_bench().prepare()
        book = self.page.book
        if book is not None and book.whole and self.page.end() >= len(book.layout):
            self.progress.reached_end()
        self._say_round()
        if self._place_timer is not None:
            self._place_timer.stop()
        self._place_timer = self.set_timer(_SETTLED, self.keep_place)

    def _is_offered(self, item: Item) -> bool:
        """Whether keys act on it unasked: what is open to be done, and never a link."""
        if item.kind == "question":
            return self._open_question(item) is not None
        if item.kind == "cell":
            return True
        if item.kind == "answer":
            question = self._answered_at(item.block)
            said = self.progress.prediction(question) if question else None
            return said is not None and said.judged is None
        return False

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
        head = _short(head, self._width - 2)
        end = page.end()
        share = end / max(1, len(layout))
        if not book.whole:
            position = ""
        else:
            last = layout.rows[end - 1].block if end else 0
            minutes = script.minutes_left(last + 1)
            left = "the end" if end >= len(layout) else f"{max(1, round(minutes))} min left"
            number = len(layout.starts) if end >= len(layout) else layout.number(page.top)
            position = f"{number} of {len(layout.starts)} · {left}"
        words, since = self._message
        keys = words if words and self._clock() - since < _MESSAGE else self._keys()
        page.words = Words(head, _short(keys, self._width - 2), position, share)
        page.refresh()

    def _keys(self) -> str:  # noqa: PLR0911 - one return per kind
        """The keys that matter here."""
        if self._bench is not None and self._bench.cell is not None:
            return "the cell runs   Ctrl-C stop it"
        item = self.page.item
        general = "Space on   t contents   / search   ? keys   q leave"
        if item is None:
            return general
        if item.kind == "question":
            open_ = self._open_question(item) is not None
            return "Enter predict   s skip   ? keys" if open_ else general
        if item.kind == "cell":
            return "r run   e change   u undo   c copy   w write   Space on   ? keys"
        if item.kind == "figure":
            return "Enter or o: open the figure   Space on   ? keys"
        if item.kind == "answer":
            return "were you 1 right   2 nearly right   3 wrong   Space on"
        return _short(f"Enter: {self._leads(item.target)}   Tab next   Space on", self._width - 2)

    def _leads(self, target: str) -> str:
        kind, _, rest = target.partition(":")
        if target.startswith("#"):
            return f"go to {target[1:].replace('-', ' ')}"
        return f"open {rest.partition('#')[0]}" if kind in {"lesson", "exercise"} else f"open {target}"

    def say(self, message: str) -> None:
        """Show something in the last line for a moment."""
        self._message = (message, self._clock())
        self._say_round()

    def _tick(self) -> None:
        words, since = self._message
        if words and self._clock() - since >= _MESSAGE:
            self._message = ("", 0.0)
            self._say_round()
        cell = self._bench.cell if self._bench is not None else None
        if cell is not None:
            self._rebuild(cell.index)

    def _busy(self) -> tuple[str, str]:
        return self._bench.busy() if self._bench is not None else ("", "")

    def _picture(self, figure_id: str, width: int) -> list[Text]:
        if self._pictures is None:
            return []
        picture: list[Text] = self._pictures.rows(figure_id, width, self.page.room, self._drawn)
        return picture

    def _drawn(self, figure_id: str) -> None:
        """A picture has arrived (from another thread)."""
        with contextlib.suppress(RuntimeError):  # the reader is gone
            self.call_from_thread(self._take_picture, figure_id)

    def _take_picture(self, figure_id: str) -> None:
        from course.catalog import blocks as b

        for index, block in enumerate(self.progress.script.blocks):
            if any(isinstance(one, b.Figure) and one.id == figure_id for one in b.walk_blocks((block,))):
                self._rebuild(index)

    def _tail(self, printer: ScreenPrinter) -> BlockRows:
        """After the last line: that it is read, and what is next."""
        lesson = self.progress.script.lesson
        ids = self.catalog.lesson_ids()
        following = ids[ids.index(lesson.id) + 1 :][:1] if lesson.id in ids else ()
        open_ = [q for q in self.progress.script.questions if self.progress.prediction(q) is None]
        words: list[tuple[str, str]] = [
            (f"exercise:{name}", f"Practise: {name}") for name in lesson.exercises
        ]
        words += [(f"lesson:{name}", f"Next lesson: {self.catalog.lesson(name).title}") for name in following]
        shown: list[Any] = [Text("─" * 20, style="dim"), Text("You have read this lesson.", style="bold")]
        if open_:
            count = len(open_)
            shown.append(
                Text(f"{count} prediction{'s are' if count != 1 else ' is'} still open: t shows where.")
            )
        shown.append(Text(""))
        return printer.tail_rows(Group(*shown), words, len(self.progress.script.blocks))

    # -- moving --------------------------------------------------------------------------------------

    def check_action(self, action: str, parameters: tuple[object, ...]) -> bool | None:
        """Keys of the page do nothing while something is laid over it."""
        del parameters
        return (
            action in {"quit", "stop"} or len(self.screen_stack) == 1 or not hasattr(self, f"action_{action}")
        )

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
        """The next thing on this screen that keys act on; after the last, the next screen."""
        items = self.page.items()
        if not items:
            self.action_forward() if way > 0 else self.action_backward()
            return
        if self.page.item in items:
            at = items.index(self.page.item) + way
            if at < 0 or at >= len(items):
                self.action_forward() if way > 0 else self.action_backward()
                return
        else:
            at = 0 if way > 0 else len(items) - 1
        self.page.item = items[at]
        self._say_round()

    def action_return(self) -> None:
        """Back to where a link was followed."""
        if self._trail:
            self.open(*self._trail.pop())

    def on_mouse_scroll_down(self) -> None:
        """Some lines on."""
        if len(self.screen_stack) == 1:
            self.action_line(_WHEEL)

    def on_mouse_scroll_up(self) -> None:
        """Some lines back."""
        if len(self.screen_stack) == 1:
            self.action_line(-_WHEEL)

    def on_click(self, event: Any) -> None:
        """Follow a link; choose anything else, and act on it with a second click."""
        if len(self.screen_stack) > 1:
            return
        item = self.page.item_at(event.screen_x, event.screen_y)
        if item is None:
            return
        again = item == self.page.item
        self.page.item = item
        self._say_round()
        if item.kind in {"link", "question"} or (again and event.chain > 1):
            self.action_act()

    # -- acting --------------------------------------------------------------------------------------

    def action_act(self) -> None:
        """What Enter does here."""
        item = self.page.item
        if item is None:
            self.action_forward()
        elif item.kind == "link":
            self._follow(item.target)
        elif item.kind == "question":
            self._predict(item)
        elif item.kind == "cell":
            self.action_run_cell()
        elif item.kind == "figure":
            self.action_open_figure()
        else:
            self.action_forward()

    def _follow(self, target: str) -> None:
        kind, _, rest = target.partition(":")
        if target.startswith("#") or kind == "lesson":
            name, _, slug = rest.partition("#") if kind == "lesson" else ("", "", target[1:])
            here = self.progress.script.lesson.id
            self._trail.append((here, self.page.place() or Place()))
            script = self.progress.script if name in {"", here} else read_script(self.catalog.lesson(name))
            start = next((s.start for s in script.sections if s.slug == slug), None)
            self.open(script.lesson.id, None if start is None else Place(start))
        elif kind == "exercise":
            self._tell_exercise(rest.partition("#")[0])
        else:
            self._open_address(target)

    def _tell_exercise(self, name: str) -> None:
        from course.cli.reading.screen.asking import Tell

        exercise = self.catalog.exercise(name)
        command = f"course start {name}"
        shown = Group(
            Text(exercise.title, style="bold"),
            Text(exercise.summary),
            Text(""),
            *(Text(f"• {task.title}") for task in exercise.task),
            Text(""),
            Text.assemble(("$ ", "dim"), (command, "bold cyan"), "   puts the file and its README here"),
            Text.assemble(("$ ", "dim"), (f"course watch {name}", "bold cyan"), "   checks it at every save"),
        )

        def closed(key: str | None) -> None:
            if key == "c":
                self.copy_to_clipboard(command)
                self.say(f"Copied: {command}")

        self.push_screen(Tell(name, shown, "c", "c: copy the command   Escape: back"), closed)

    def _open_address(self, address: str) -> None:
        """A page of the web, where something can show it; its address in any case."""
        from course.cli.reading.screen.machine import can_open

        if can_open():
            import webbrowser

            webbrowser.open(address)
            self.say(f"Opened {address}")
        else:
            self.copy_to_clipboard(address)
            self.say(f"Copied: {address}")

    # -- predictions -----------------------------------------------------------------------------------

    def _open_question(self, item: Item | None) -> Question | None:
        """The prediction that an item is about, or that closes it, if it is still open."""
        if item is None:
            return None
        question = self.progress.script.question_at(item.block) or self.progress.closed_by(item.block)
        return question if question and self.progress.prediction(question) is None else None

    def _predict(self, item: Item) -> None:
        from course.cli.reading.screen.asking import Predict

        question = self._open_question(item)
        if question is None:
            self.action_forward()
            return

        def said(text: str | None) -> None:
            if text:
                self._answered(question, text)

        self.push_screen(Predict(question.words), said)

    def _answered(self, question: Question, text: str) -> None:
        self.progress.predict(question, text)
        self._rebuild(*range(question.index, question.end), len(self.progress.script.blocks))
        self.page.item = None
        self._settle()
        cells = [c for c in self.progress.script.shown_cells if question.index < c.index < question.end]
        run = "Run the cell: r. " if cells else ""
        self.say(f"{'Kept' if text else 'Skipped'}. {run}What comes out is open now.")

    def action_skip(self) -> None:
        """Open an answer without a prediction; that is kept, too."""
        question = self._open_question(self.page.item)
        if question is not None:
            self._answered(question, "")

    def _answered_at(self, block: int) -> Question | None:
        return next((one for one in self.progress.script.questions if one.answer == block), None)

    def action_judge(self, key: str) -> None:
        """How a prediction did, by the reader's own word."""
        item = self.page.item
        question = self._answered_at(item.block) if item is not None and item.kind == "answer" else None
        if question is not None:
            self.progress.judge(question, _JUDGED[key])  # type: ignore[arg-type]
            self._rebuild(item.block if item else 0)

    # -- cells -----------------------------------------------------------------------------------------

    def _cell(self) -> Cell | None:
        """The cell at hand: the chosen one, or the first in sight."""
        item = self.page.item
        if item is None or item.kind != "cell":
            item = next((one for one in self.page.items() if one.kind == "cell"), None) or self._cell_ahead()
        if item is None:
            question = self._open_question(self.page.item)
            self.say("Predict first: Enter, or s to skip." if question else "No cell in sight.")
            return None
        self.page.item = item
        return self.progress.script.cell_at(item.block)

    def _cell_ahead(self) -> Item | None:
        """The cell of the last prediction on the screen, where its answer is open but it is further down."""
        book, script = self.page.book, self.progress.script
        for item in reversed(self.page.items()):
            question = script.question_at(item.block) if item.kind == "question" else None
            if book is None or question is None or self.progress.prediction(question) is None:
                continue
            found = next(
                (
                    one
                    for one in book.items
                    if one.kind == "cell" and question.index < one.block < question.end
                ),
                None,
            )
            if found is not None:
                self._show(book.layout.row(Place(found.block)))
                return found
        return None

    def action_run_cell(self) -> None:
        """Run the cell at hand."""
        cell = self._cell()
        if cell is None:
            return
        if self._at_bench().start(cell):
            self._rebuild(cell.index)
        else:
            self.say("A cell is running; Ctrl-C stops it.")

    def _at_bench(self) -> Bench:
        """Where this lesson's cells run."""
        if self._bench is None:
            progress = self.progress

            def done(cell: Cell, source: str, gave: Gave) -> None:
                with contextlib.suppress(RuntimeError):  # the reader is gone
                    self.call_from_thread(self._took, progress, cell, source, gave)

            self._bench = Bench(progress, done, self._clock)
        return self._bench

    def _took(self, progress: InProgress, cell: Cell, source: str, gave: Gave) -> None:
        progress.ran(cell, source, gave.printed, gave.error, gave.seconds)
        if progress is self.progress:
            question = next((q for q in progress.script.questions if q.index < cell.index < q.end), None)
            answer = [question.answer] if question is not None and question.answer is not None else []
            self._rebuild(cell.index, *answer)
            self._bring_to_sight(cell.index)
            if gave.earlier:
                ran = ", ".join(map(str, gave.earlier))
                self.say(f"Cell {ran} ran first." if len(gave.earlier) == 1 else f"Cells {ran} ran first.")
            self._say_round()

    def _bring_to_sight(self, block: int) -> None:
        """The end of a block on the screen: that is where a cell's output is."""
        book = self.page.book
        span = book.layout.span(block) if book is not None else None
        if span is not None and not self.page.top < span[1] <= self.page.end():
            self.page.go(max(0, span[1] - self.page.room), paged=False)
            self._settle()

    def _end_cells(self) -> None:
        if self._bench is not None:
            self._bench.close()
            self._bench = None

    def action_edit(self) -> None:
        """Change the cell at hand."""
        cell = self._cell()
        if cell is None:
            return
        from course.cli.reading.screen.asking import Edit

        def done(result: tuple[str, bool] | None) -> None:
            if result is None:
                return
            source, run = result
            self.progress.edit(cell, source.rstrip("\n"))
            self._rebuild(cell.index)
            if run:
                self.action_run_cell()

        self.push_screen(Edit(f"Cell {cell.number}", self.progress.cell(cell).source), done)

    def action_undo(self) -> None:
        """The lesson's own code again."""
        cell = self._cell()
        if cell is not None:
            self.progress.edit(cell, cell.source)
            self._rebuild(cell.index)
            self.say("The lesson's own code again.")

    def action_copy(self) -> None:
        """Copy the cell at hand."""
        cell = self._cell()
        if cell is not None:
            self.copy_to_clipboard(self.progress.cell(cell).source + "\n")
            self.say(f"Cell {cell.number} is copied, if your terminal allows it; w writes a file.")

    def action_write_cell(self) -> None:
        """Write the cell at hand into a file of the current folder."""
        cell = self._cell()
        if cell is None:
            return
        from course.cli.reading.screen.machine import write_new

        name = f"{self.progress.script.lesson.id}-{cell.number}.py"
        try:
            path = write_new(name, self.progress.cell(cell).source + "\n")
        except CourseError as error:
            self.say(error.message)
        else:
            self.say(f"Wrote {path}")

    def action_open_figure(self) -> None:
        """The figure at hand in the system's viewer."""
        item = self.page.item
        if item is None or item.kind != "figure":
            item = next((one for one in self.page.items() if one.kind == "figure"), None)
        if item is None:
            self.say("No figure in sight.")
            return
        if self._pictures is None:
            self.say(f"course lesson {self.progress.script.lesson.id} --figures DIR writes the pictures.")
            return
        self.say("Drawing the figure …")
        self._pictures.open(item.target, lambda words: self.call_from_thread(self.say, words))

    # -- finding ---------------------------------------------------------------------------------------

    def action_contents(self) -> None:
        """The sections of this lesson, and the other lessons, with what is done."""
        from course.cli.reading.screen.asking import Choose

        script, progress = self.progress.script, self.progress
        self.keep_place()
        options: list[tuple[str, str]] = []
        at = ""
        place = self.page.place() or Place()
        for section in script.sections:
            done = progress.is_done(section.start, section.end)
            asked = [q for q in script.questions if section.start <= q.index < section.end]
            open_ = sum(progress.prediction(q) is None for q in asked)
            more = f"   {open_} to predict" if open_ and section.level == 2 else ""
            indent = "  " * (section.level - 2)
            options.append(
                (f"block:{section.start}", f"{'✓' if done else ' '} {indent}{section.title}{more}")
            )
            if section.start <= place.block and section.level == 2:
                at = f"block:{section.start}"
        options.append(("", ""))
        for number, name in enumerate(self.catalog.lesson_ids(), start=1):
            read = self._is_read(name)
            options.append(
                (f"lesson:{name}", f"{'✓' if read else ' '} {number}. {self.catalog.lesson(name).title}")
            )
        self.push_screen(Choose(script.lesson.title, options, at), self._chosen)

    def _is_read(self, name: str) -> bool:
        opened = self._opened.get(name)
        return opened.read if opened is not None else any(e.kind == "lesson" for e in self._events(name))

    def _chosen(self, key: str | None) -> None:
        """Go where a list says: "block:12", "lesson:ID" or "lesson:ID:12"."""
        if not key:
            return
        kind, _, rest = key.partition(":")
        name, _, block = rest.partition(":")
        self._trail.append((self.progress.script.lesson.id, self.page.place() or Place()))
        if kind == "lesson":
            self.open(name, Place(int(block)) if block else None)
        elif self.page.book is not None:
            self._show(self.page.book.layout.row(Place(int(rest))))

    def action_search(self) -> None:
        """Look for words."""
        from course.cli.reading.screen.asking import Find

        self.push_screen(Find(self._search), self._chosen)

    def _search(self, wanted: str) -> list[tuple[str, str]]:
        from course.reading.finding import find

        self._wanted = wanted
        here = self.progress.script.lesson.id
        hits: list[tuple[str, str]] = []
        for name in (here, *(other for other in self.catalog.lesson_ids() if other != here)):
            progress = self._opened.get(name)
            if progress is None:
                progress = InProgress(read_script(self.catalog.lesson(name)), self._events(name))
            script = progress.script
            found = find(script, wanted, closed=partial(self._hides, progress))
            hits += [(f"lesson:{name}:{hit.block}", f"{script.lesson.id}: {hit.excerpt}") for hit in found]
        return hits

    @staticmethod
    def _hides(progress: InProgress, index: int) -> bool:
        return progress.closed_by(index) is not None and progress.script.gives_away(index)

    def action_next_hit(self) -> None:
        """The next place in this lesson where the words are."""
        from course.reading.finding import find

        if not self._wanted:
            self.say("/ looks for words.")
            return
        place = self.page.place() or Place()
        blocks = [
            hit.block
            for hit in find(
                self.progress.script, self._wanted, closed=lambda i: self._hides(self.progress, i)
            )
        ]
        following = [block for block in blocks if block > place.block] or blocks
        if not following or self.page.book is None:
            self.say(f"{self._wanted!r} is not in this lesson; / looks in all.")
            return
        self._show(self.page.book.layout.row(Place(following[0])))

    def action_help(self) -> None:
        """All keys."""
        from rich.table import Table

        from course.cli.reading.screen.asking import Tell

        grid = Table.grid(padding=(0, 2, 0, 0))
        grid.add_column(no_wrap=self._width >= 60)
        grid.add_column()
        for key, what in _HELP:
            grid.add_row(Text(key, style="bold"), Text(what))
        self.push_screen(Tell("Keys", grid))

    # -- leaving ---------------------------------------------------------------------------------------

    def action_stop(self) -> None:
        """Stop the cell that runs; else leave."""
        if self._bench is not None and self._bench.cell is not None:
            self._bench.interrupt()
        else:
            self.action_quit_now()

    async def action_quit(self) -> None:
        """Leave."""
        self.action_quit_now()

    def action_quit_now(self) -> None:
        """Leave; the place is kept."""
        self.keep_place()
        self.exit()


def _short(text: str, width: int) -> str:
    return text if len(text) <= width else text[: max(1, width - 1)].rstrip() + _SHORT_OF
