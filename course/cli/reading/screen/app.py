"""The reader's program: the actions of keys and mouse on a lesson in the full-screen reader."""

from __future__ import annotations

from typing import Any, ClassVar

from textual.binding import Binding

from course.cli.reading.screen.doing import TasksApp
from course.cli.reading.screen.printing import Item
from course.cli.reading.screen.telling import contents, keys_table
from course.full_screen import TextOverlay
from course.reading.parts import Question
from course.reading.record import InProgress, Judgement, Place

_JUDGED: dict[str, Judgement] = {"1": "right", "2": "nearly", "3": "wrong"}


class ReaderApp(TasksApp):
    """A lesson to predict, run, practise, follow and search."""

    BINDINGS: ClassVar[list[Any]] = [
        Binding("enter", "act", show=False),
        Binding("s", "skip", show=False),
        Binding("1", "judge('1')", show=False),
        Binding("2", "judge('2')", show=False),
        Binding("3", "judge('3')", show=False),
        Binding("o", "open_figure", show=False),
        Binding("t", "contents", show=False),
        Binding("slash", "search", show=False),
        Binding("n", "next_hit", show=False),
        Binding("backspace,left", "return", show=False),
        Binding("question_mark,f1", "help", show=False),
    ]

    #: Where links were followed from.
    _trail: tuple[tuple[str, Place], ...] = ()
    _wanted = ""

    def _is_offered(self, item: Item) -> bool:
        """Whether keys act on it by default: open tasks, and never a link."""
        if item.kind == "question":
            return self.progress.asked_by(item.block) is not None
        if item.kind == "answer":
            question = self.progress.script.answered_at(item.block)
            said = self.progress.prediction(question) if question else None
            return said is not None and said.judged is None
        return super()._is_offered(item)

    def _keys(self) -> str:
        item, keys = self.page.item, self._keys_at_hand()
        asks = item is not None and item.kind == "answer"  # its own keys say it
        if asks or self._cell_that_runs is not None or self._unjudged() is None:
            return keys
        return f"1 right, 2 nearly, 3 wrong   {keys}"

    def _keys_at_hand(self) -> str:
        item = self.page.item
        if self._cell_that_runs is not None or (item is not None and item.kind in {"cell", "task"}):
            return super()._keys()
        general = "Space on   t contents   / search   ? keys   q leave"
        if item is None:
            return general
        match item.kind:
            case "question":
                open_ = self.progress.asked_by(item.block) is not None
                return "Enter predict   s skip   ? keys" if open_ else general
            case "figure":
                return "Enter or o: open the figure   Space on   ? keys"
            case "answer":
                return "were you 1 right, 2 nearly, 3 wrong   Space on"
            case _:
                return f"Enter: {self._leads(item.target)}   Tab next   Space on"

    def _leads(self, target: str) -> str:
        kind, _, rest = target.partition(":")
        if target.startswith("#"):
            return f"go to {target[1:].replace('-', ' ')}"
        return f"open {rest.partition('#')[0]}" if kind in {"lesson", "exercise"} else f"open {target}"

    def action_return(self) -> None:
        """Back to where a link was followed."""
        if self._trail:
            *before, last = self._trail
            self._trail = tuple(before)
            self.open(*last)

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

    # -- acting ------------------------------------------------------------------------------------------

    def action_act(self) -> None:
        """Do what Enter does here."""
        item = self.page.item
        if item is None:
            self.action_forward()
        elif item.kind == "link":
            self._follow(item.target)
        elif item.kind == "question":
            self._predict(item)
        elif item.kind in {"cell", "task"}:
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
            self._leave_trail()
            self.open_at(name or here, slug)
        elif kind == "exercise":
            self._go_to_task(rest.partition("#")[0])
        else:
            self._open_address(target)

    def _leave_trail(self) -> None:
        self._trail += ((self.progress.script.lesson.id, self.page.place() or Place()),)

    def _go_to_task(self, name: str) -> None:
        """Where a warm-up or an exercise is done: in the lesson that leads to it."""
        lesson = self.catalog.exercise(name).lesson
        here = self.progress.script
        self._leave_trail()
        script = here if lesson == here.lesson.id else self._script_of(lesson)
        self.open(lesson, Place(script.task(name)))

    def _open_address(self, address: str) -> None:
        """Open a web page where a browser can show it; print its address in any case."""
        from course.browser import opened

        if opened(address):
            self.say(f"Opened {address}")
        else:
            self.copy_to_clipboard(address)
            self.say(f"Copied: {address}")

    # -- predictions -------------------------------------------------------------------------------------

    def _predict(self, item: Item) -> None:
        from course.cli.reading.screen.asking import Predict

        question = self.progress.asked_by(item.block)
        if question is None:
            self.action_forward()
            return

        def said(text: str | None) -> None:
            if text:
                self._answered(question, text)

        self.push_screen(Predict(question.words), said)

    def _answered(self, question: Question, text: str) -> None:
        self.progress.predict(question, text)
        script = self.progress.script
        self._rebuild(*range(question.index, question.end), script.after(question), len(script.blocks))
        self.page.item = None
        self._settle()
        cells = [c for c in self.progress.script.shown_cells if question.index < c.index < question.end]
        run = " r: run" if cells else ""
        self.say(f"{'Kept' if text else 'Skipped'}. The answer is open.{run}")

    def action_skip(self) -> None:
        """Open an answer without a prediction; that is kept, too."""
        item = self.page.item
        question = self.progress.asked_by(item.block) if item is not None else None
        if question is not None:
            self._answered(question, "")

    def _unjudged(self) -> Item | None:
        """The first answer in sight whose prediction is not judged yet."""
        answers = (one for one in self.page.items() if one.kind == "answer")
        return next((one for one in answers if self._is_offered(one)), None)

    def action_judge(self, key: str) -> None:
        """How good a prediction was, in the reader's own judgement."""
        item = self.page.item
        if item is None or item.kind != "answer":  # the cell above it is at hand
            item = self._unjudged()
        question = self.progress.script.answered_at(item.block) if item is not None else None
        if item is not None and question is not None:
            self.progress.judge(question, _JUDGED[key])
            self._rebuild(question.index, item.block)

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

    # -- finding -----------------------------------------------------------------------------------------

    def action_contents(self) -> None:
        """The sections of this lesson, and the other lessons, with what is done."""
        from course.cli.reading.screen.asking import ChoiceOverlay

        self.keep_place()
        here = (self.page.place() or Place()).block
        options, at = contents(self.catalog, self.progress, here, self._is_read, self._practice)
        self.push_screen(ChoiceOverlay(self.progress.script.lesson.title, options, at), self._chosen)

    def _is_read(self, name: str) -> bool:
        opened = self._opened.get(name)
        return opened.read if opened is not None else any(e.kind == "lesson" for e in self._events(name))

    def _chosen(self, key: str | None) -> None:
        """Go where a list says: "block:12", "lesson:ID" or "lesson:ID:12"."""
        if not key:
            return
        kind, _, rest = key.partition(":")
        name, _, block = rest.partition(":")
        self._leave_trail()
        if kind == "lesson":
            self.open(name, Place(int(block)) if block else None)
        elif self.page.book is not None:
            self._show(self.page.book.layout.row(Place(int(rest))))

    def action_search(self) -> None:
        """Look for words."""
        from course.cli.reading.screen.asking import Find

        self.push_screen(Find(self._search), self._chosen)

    def _search(self, wanted: str) -> list[tuple[str, str]]:
        from course.reading.record import find

        self._wanted = wanted
        here = self.progress.script.lesson.id
        hits: list[tuple[str, str]] = []
        for name in (here, *(other for other in self.catalog.lesson_ids() if other != here)):
            progress = self._opened.get(name)
            if progress is None:
                progress = InProgress(self._script_of(name), self._events(name))
            found = find(progress, wanted)
            hits += [(f"lesson:{name}:{hit.block}", f"{name}: {hit.excerpt}") for hit in found]
        return hits

    def action_next_hit(self) -> None:
        """The next place in this lesson where the words are."""
        from course.reading.record import find

        if not self._wanted:
            self.say("/ searches for words.")
            return
        place = self.page.place() or Place()
        blocks = [hit.block for hit in find(self.progress, self._wanted)]
        following = [block for block in blocks if block > place.block] or blocks
        if not following or self.page.book is None:
            self.say(f"{self._wanted!r} is not in this lesson; / searches all lessons.")
            return
        self._show(self.page.book.layout.row(Place(following[0])))

    def action_help(self) -> None:
        """All keys."""
        self.push_screen(TextOverlay("Keys", [keys_table(self._width)]))
