"""The full-screen reader: what its keys and the mouse do, and what is found from any page."""

from typing import Any, ClassVar

from textual.app import ComposeResult
from textual.binding import Binding
from textual.events import Resize

from course.catalog.blocks import Task
from course.catalog.load import Catalog
from course.cli.reading.screen import items
from course.cli.reading.screen.asking import Choice, Edit, Find, keys_table
from course.cli.reading.screen.page import Item, Page
from course.cli.reading.screen.running import Drawer
from course.full_screen import FullScreenApp, TextOverlay
from course.progress.workspace import Workspace
from course.reading.record import JUDGEMENTS, Place, find, unless_hidden

#: How often the last line and running work are looked at, in s.
_TICK = 0.25
_WHEEL = 3


class ReaderApp(FullScreenApp):
    """One lesson after the other on the whole screen, to predict, run, practise, follow and search.

    Args:
        first: id of the lesson to open.
        section: slug of the section to open it at; where it was left if empty.
        workspace: the student's; None outside of one.
        pictures: draws figures for this terminal; None to describe them.

    Attributes:
        page: the lesson that is open, and the items on it that keys act on.
    """

    # Letters of the page beside a box would be read with it.
    CSS = "Screen { overflow: hidden; } Overlay { background: $background; }"
    ALWAYS = FullScreenApp.ALWAYS | {"stop"}
    BINDINGS: ClassVar[list[Any]] = [
        Binding(keys, action, show=False, priority=keys in {"ctrl+q", "ctrl+c", "tab", "shift+tab"})
        for keys, action in (
            ("ctrl+q", "quit"),
            ("q", "quit"),
            ("ctrl+c", "stop"),
            ("space,pagedown,f", "turn('next')"),
            ("b,pageup,shift+space", "turn('previous')"),
            ("down,j", "line(1)"),
            ("up,k", "line(-1)"),
            ("g,home", "turn('first')"),
            ("G,end", "turn('last')"),
            ("tab", "item(1)"),
            ("shift+tab", "item(-1)"),
            ("enter", "act"),
            ("s", "skip"),
            ("1", "judge(1)"),
            ("2", "judge(2)"),
            ("3", "judge(3)"),
            ("r", "do('run')"),
            ("e", "do('edit')"),
            ("u", "do('undo')"),
            ("c", "do('copy')"),
            ("w", "do('write')"),
            ("h", "hint"),
            ("o", "open_figure"),
            ("t", "contents"),
            ("slash", "search"),
            ("n", "next_hit"),
            ("backspace,left", "return"),
            ("question_mark,f1", "help"),
        )
    ]

    def __init__(
        self,
        catalog: Catalog,
        first: str,
        section: str = "",
        workspace: Workspace | None = None,
        pictures: Drawer | None = None,
    ) -> None:
        super().__init__()
        self.catalog = catalog
        self._first, self._section = first, section
        self._wanted = ""
        shown = pictures if self.in_colour else None
        self.page = Page(self, catalog, workspace, shown, items.items_of, items.keys_of)

    # -- coming and going --------------------------------------------------------------------------------

    def play(self) -> None:
        """Read until the reader leaves; whatever happens, the record is written."""
        try:
            super().play()
        finally:
            self.page.close()

    def compose(self) -> ComposeResult:
        yield self.page

    def on_mount(self) -> None:
        self.page.focus()
        self.set_interval(_TICK, self.page.tick)
        self.page.open(self._first, section=self._section)

    def on_unmount(self) -> None:
        self.page.end_cells()
        self.page.keep_place()
        if self.page.pictures is not None:
            self.page.pictures.close()

    def on_resize(self, event: Resize) -> None:
        if event.size != self.page.laid_for:
            self.call_after_refresh(self.page.reflow)

    async def action_quit(self) -> None:
        """Leave, unless what was typed cannot be kept."""
        if self._keeps_what_was_typed():
            self.action_quit_now()

    def action_quit_now(self) -> None:
        """Leave, as a signal asks for; the place is kept, and what was typed into an editor."""
        self._keeps_what_was_typed()
        self.page.keep_place()
        super().action_quit_now()

    def _keeps_what_was_typed(self) -> bool:
        return all(box.keep_changes() for box in self.screen_stack if isinstance(box, Edit))

    def action_stop(self) -> None:
        """Copy what is selected in an editor; else stop the cell that runs; else leave the editor, or all."""
        editor = self.screen if isinstance(self.screen, Edit) else None
        if editor is not None and editor.copied():
            return
        if self.page.bench is not None and self.page.running is not None:
            self.page.bench.interrupt()
        elif editor is not None:
            editor.leave()
        else:
            self.action_quit_now()

    def say(self, message: str) -> None:
        super().say(message)
        self.page.say_round()

    # -- moving ------------------------------------------------------------------------------------------

    def action_turn(self, to: str) -> None:
        """The next screen, the previous, the first or the last."""
        layout = self.page.book.layout
        if to == "next":
            self.page.forward()
        else:
            others = {"previous": layout.previous(self.page.top), "first": 0, "last": layout.last}
            self.page.show(others[to])

    def action_line(self, lines: int) -> None:
        last = len(self.page.book.layout) - self.page.room
        self.page.go(max(0, min(self.page.top + lines, last)), paged=False)
        self.page.settle()

    def action_item(self, way: int) -> None:
        """The next thing on this screen that keys act on, links last; then the first of the next screen."""
        self.hush()
        found, item = sorted(self.page.items(), key=lambda one: one.inline), self.page.item
        at = found.index(item) + way if item in found else (0 if way > 0 else -1)
        if not found or at >= len(found) or (at < 0 and item in found):
            self.action_turn("next" if way > 0 else "previous")
            found, at = sorted(self.page.items(), key=lambda one: one.inline), 0 if way > 0 else -1
        if found:
            self.page.item = found[at]
            self.page.say_round()

    def action_return(self) -> None:
        if self.page.trail:
            self.page.open(*self.page.trail.pop())

    def on_mouse_scroll_down(self) -> None:
        if len(self.screen_stack) == 1:
            self.action_line(_WHEEL)

    def on_mouse_scroll_up(self) -> None:
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
        self.page.say_round()
        if item.at_once or (again and event.chain > 1):
            item.act(self.page)

    # -- acting ------------------------------------------------------------------------------------------

    def action_act(self) -> None:
        if self.page.item is not None:
            self.page.item.act(self.page)
        else:
            self.page.forward()

    def action_do(self, act: str) -> None:
        """Run or change the task at hand, or else the cell; undo, copy or write the cell."""
        item: Item | None = self.page.item
        if not (isinstance(item, items.TaskItem) and hasattr(item, act)):
            item = items.cell_at_hand(self.page)
        if item is not None:
            getattr(item, act)(self.page)

    def action_hint(self) -> None:
        """The hint that is due at the task at hand; all keys elsewhere."""
        if isinstance(self.page.item, items.TaskItem):
            self.page.item.ask_hint(self.page)
        else:
            self.action_help()

    def action_skip(self) -> None:
        """Open the answer at hand without a prediction."""
        item = self.page.item
        question = self.page.progress.asked_by(item.block) if item is not None else None
        if question is not None:
            items.answer(self.page, question, "")

    def action_judge(self, key: int) -> None:
        """How good a prediction was; its answer may be in sight while the cell above it is at hand."""
        item = self.page.item
        judged = item if isinstance(item, items.AnswerItem) else items.unjudged(self.page)
        if judged is not None:
            judged.judge(self.page, JUDGEMENTS[key - 1])

    def action_open_figure(self) -> None:
        figure = items.in_sight(self.page, items.FigureItem)
        if figure is not None:
            figure.act(self.page)
        else:
            self.say("No figure in sight.")

    # -- finding -----------------------------------------------------------------------------------------

    def action_contents(self) -> None:
        """The sections of this lesson with its tasks, and all lessons, with what is done."""
        page = self.page
        page.keep_place()
        progress, script, options, at = page.progress, page.progress.script, list[tuple[str, str]](), ""
        here = (page.place() or Place()).block
        for section in script.sections:
            done = progress.is_done(section.start, section.end)
            asked = [q for q in script.questions if section.start <= q.index < section.end]
            open_ = sum(progress.prediction(q) is None for q in asked)
            more = f"   {open_} to predict" if open_ and section.level == 2 else ""
            indent = "  " * (section.level - 2)
            words = f"{'✓' if done else ' '} {indent}{section.title}{more}"
            options.append((f"block:{section.start}", words))
            if section.start <= here and section.level == 2:
                at = f"block:{section.start}"
            for index, block in enumerate(script.blocks):
                if isinstance(block, Task) and script.section_at(index) == section:
                    mark = "✓" if page.practice.of(block.id).done else " "
                    words = f"{mark}   {block.what.partition(',')[0]}: {block.title}"
                    options.append((f"block:{index}", words))
        options.append(("", ""))
        for number, name in enumerate(page.catalog.lesson_ids(), start=1):
            words = f"{'✓' if page.is_read(name) else ' '} {number}. {page.catalog.lesson(name).title}"
            options.append((f"lesson:{name}", words))
        self.push_screen(Choice(script.lesson.title, options, at), self._chosen)

    def _chosen(self, key: str | None) -> None:
        """Go where a list says: "block:12", "lesson:ID" or "lesson:ID:12"."""
        if not key:
            return
        kind, name, block = f"{key}::".split(":")[:3]
        self.page.leave_trail()
        if kind == "lesson":
            self.page.open(name, Place(int(block)) if block else None)
        else:
            self.page.show(self.page.book.layout.row(Place(int(name))))

    def action_search(self) -> None:
        self.push_screen(Find(self._search), self._chosen)

    def _search(self, wanted: str) -> list[tuple[str, str]]:
        self._wanted = wanted
        here = self.page.progress.script.lesson.id
        names = (here, *(other for other in self.catalog.lesson_ids() if other != here))
        lessons = {name: self.page.in_progress(name) for name in names}
        hits = [
            (f"lesson:{name}:{hit.block}", f"{name}: {hit.excerpt}")
            for name, lesson in lessons.items()
            for hit in find(lesson, wanted)
        ]
        return hits or [("", f"In no lesson{unless_hidden(*lessons.values())}")]

    def action_next_hit(self) -> None:
        if not self._wanted:
            self.say("/ searches for words.")
            return
        place = self.page.place() or Place()
        blocks = [hit.block for hit in find(self.page.progress, self._wanted)]
        following = [block for block in blocks if block > place.block] or blocks
        if not following:
            nowhere = f"{self._wanted!r} is not in this lesson{unless_hidden(self.page.progress)}"
            self.say(f"{nowhere} / searches all lessons.")
            return
        self.page.show(self.page.book.layout.row(Place(following[0])))

    def action_help(self) -> None:
        self.push_screen(TextOverlay("Keys", [keys_table(self.size.width)]))
