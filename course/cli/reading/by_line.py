"""A lesson read by lines: one page at a time; typed words do what keys do in the full-screen reader.

Each line is written once and stays: nothing is drawn again, so a screen reader says it once.
"""

import bisect
import contextlib
import itertools
import re
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import wait
from functools import partial
from pathlib import Path

from course.catalog import blocks as b
from course.catalog.load import Catalog
from course.catalog.models import Exercise, Lesson
from course.cli.frame.app import again
from course.cli.frame.console import Console
from course.cli.frame.here import Here
from course.cli.reading.lesson import Printer, paginate
from course.cli.reading.screen.running import Bench, write_cell
from course.errors import CourseError
from course.printable import counted
from course.progress.history import lesson_events
from course.progress.store import Event
from course.reading.cells import CellOutput
from course.reading.parts import Cell, Question, read_script
from course.reading.record import JUDGEMENTS, InProgress, Place, find, unless_hidden

_ON_WORDS, _STOP = ("", "y", "yes", "n", "next"), ("q", "quit", "no")
_ON = "Enter goes on"
#: Commands while a prediction is open; everything else is the prediction.
_LEADS_ELSEWHERE = re.compile(r"[?bt]|g \d+|/.+|course .+")
#: After this time a running cell is announced, in s.
_PATIENCE = 1.0
_WORDS = (
    ("Enter, n", "the next page"),
    ("b", "the page before"),
    ("t", "contents, with the page of each section; g and a number goes to a page"),
    ("/ and words", "where they are in this lesson"),
    ("r", "run the cell; r and a number runs that cell"),
    ("e", "put the cell into a file for your editor; r then runs what the file holds"),
    ("u", "put the lesson's own code back into the cell"),
    ("1, 2, 3", "below an answer: you were right, nearly right, wrong"),
    ("start, check, hint", "for the warm-up or the exercise of this page"),
    ("q or Ctrl-C", "stop; your place is kept. While a cell runs, Ctrl-C stops the cell"),
)


class LineReader:
    """One lesson in progress on a terminal that is written to line by line.

    Args:
        here: the student's workspace; None outside of one, where nothing is kept.
        shown: prints it.
    """

    def __init__(
        self, console: Console, here: Here | None, catalog: Catalog, lesson: Lesson, shown: Printer
    ) -> None:
        self._console, self._here, self._catalog, self._shown = console, here, catalog, shown
        self._script = read_script(lesson, catalog.tasks(lesson.id))
        self._pages = paginate(self._script.blocks)
        self._starts = list(itertools.accumulate(map(len, self._pages), initial=0))
        self._events: tuple[Event, ...] = ()
        with contextlib.suppress(CourseError):  # where the record cannot be read, there is none
            store = here.workspace.store if here else None
            self._events = lesson_events(store, lesson.id, catalog.syllabus.split)
        self._progress = InProgress(self._script, self._events, self._write, catalog.version)
        self._files: dict[int, Path] = {}  # by number of the cell that the student changes in it
        self._bench = Bench(self._progress)
        self._kept = False  # whether the last event was recorded
        self._does: dict[str, Callable[[str, int], int | None]] = {
            "b": lambda _, page: max(0, page - 1),
            "t": self._contents,
            "g": self._go,
            "r": partial(self._with_cell, self._run),
            "e": partial(self._with_cell, self._edit),
            "u": partial(self._with_cell, self._undo),
            **{word: partial(self._with_task, word) for word in ("start", "check", "hint")},
            "?": self._help,
        }

    def read(self) -> bool:
        """Continue at the student's place; False if the student stops before the end."""
        number: int | None = _page(self._events, self._progress.place.block, self._starts)
        if number:
            self._say(f"Going on with page {number + 1} of {len(self._pages)}.")
        self._say("What you type below a page does something; ? lists what.")
        try:
            while number is not None and number < len(self._pages):
                number = self._opened(number)
                self._show(number)
                number = self._talk(number)
        finally:
            self._bench.close()
        return number is not None

    # -- a page ----------------------------------------------------------------------------------------

    def _opened(self, number: int) -> int:
        """The page, or the one with the open prediction that it would answer."""
        if (question := self._progress.closed_by(self._starts[number])) is None:
            return number
        self._say("Predict first.")
        return bisect.bisect_right(self._starts, question.index) - 1

    def _show(self, number: int) -> None:
        task = self._task(number)
        if task is None:
            if number == 0:
                self._shown.head()
            self._shown.blocks(self._pages[number])
            if self._cells(number):
                self._bench.prepare()  # so that the first run need not wait for its process
            return
        self._console.blank()
        what = f"Warm-up, {counted(task.minutes, 'minute')}" if task.is_warm_up else "Exercise"
        self._say(f"{what}: {task.title} ({task.id})")
        self._say(task.summary)

    def _talk(self, number: int) -> int | None:
        """Obey the student's words below a page, until one leads to another page; None to stop."""
        question = self._asked(number)
        is_open = question is not None and self._progress.prediction(question) is None
        following = self._starts[number if is_open else min(number + 1, len(self._pages) - 1)]
        self._progress.at(Place(following), self._starts[number + 1] - 1)
        if is_open and question is not None:
            return self._predict(question, number)
        self._remind(number)
        offers = ", ".join(self._offers(number))
        if offers:
            self._say(f"Here {offers}.")
        elif number + 1 == len(self._pages):
            return number + 1
        ask = f"Page {number + 1} of {len(self._pages)}. {_ON}, q stops: "
        while (typed := self._console.ask(ask)) is not None and typed.lower() not in _STOP:
            if typed.lower() in _ON_WORDS:
                return number + 1
            leads = self._do(typed, number)
            if leads is not None:
                return leads
            ask = f"{_ON}: "
        return None

    def _offers(self, number: int) -> list[str]:
        """The actions that a page offers, besides going on."""
        offers = []
        if self._unjudged(number) is not None:
            offers.append("1 2 3 say if you were right")
        cells = self._cells(number)
        if cells:
            offers.append(f"r runs cell {cells[0].number}, e changes it")
        task = self._task(number)
        if task is not None and self._here is not None:
            there = self._here.workspace.path(task.place, task.module).is_file()
            begun = "check runs its checks, hint gives its next hint"
            offers.append(begun if there else "start puts its file into your workspace")
        return offers

    def _do(self, typed: str, number: int) -> int | None:
        """Do what a word asks for; returns the page that it leads to, if any."""
        word, _, rest = typed.partition(" ")
        if typed.startswith("/"):
            hits = list(find(self._progress, typed[1:]))
            for hit in hits:
                self._say(f"Page {max(1, bisect.bisect_right(self._starts, hit.block))}: {hit.excerpt}")
            if not hits:
                self._say(f"Not in this lesson{unless_hidden(self._progress)}")
        elif word in {"1", "2", "3"}:
            self._judge(number, int(word))
        elif word in self._does:
            return self._does[word](rest.strip(), number)
        else:
            self._say(f"{typed[:20]!r} does nothing here, and this is not the shell; ? lists what does.")
        return None

    # -- predictions -----------------------------------------------------------------------------------

    def _asked(self, number: int) -> Question | None:
        """The prediction that a page ends with."""
        return self._script.question_at(self._starts[number + 1] - 1)

    def _predict(self, question: Question, number: int) -> int | None:
        ask = "Your prediction; Enter skips it: "
        while (typed := self._console.ask(ask)) is not None and _LEADS_ELSEWHERE.fullmatch(typed):
            leads = self._do(typed, number)
            if leads is not None:
                return leads
        if typed is None or typed.lower() in _STOP[:2]:
            return None
        self._progress.predict(question, typed)
        self._say("Skipped." if not typed else "Kept." if self._kept else "Not kept.")
        return number + 1

    def _remind(self, number: int) -> None:
        """Repeat the prediction, above its answer or where it was asked."""
        question = self._asked(number) or self._unjudged(number)
        said = self._progress.prediction(question) if question is not None else None
        if said is not None:
            self._say(f"You said: {said.text}" if said.text else "You skipped it.")

    def _unjudged(self, number: int) -> Question | None:
        """The prediction that is answered on a page and was not judged yet."""
        found = map(self._progress.answered_at, range(self._starts[number], self._starts[number + 1]))
        return next((question for question, said in filter(None, found) if said.judged is None), None)

    def _judge(self, number: int, typed: int) -> None:
        question = self._unjudged(number)
        if question is None:
            self._say("No prediction is answered on this page.")
            return
        self._progress.judge(question, JUDGEMENTS[typed - 1])
        kept = "Kept" if self._kept else "Not kept"
        self._say(f"{kept}: {('right', 'nearly right', 'wrong')[typed - 1]}.")

    # -- cells -----------------------------------------------------------------------------------------

    def _cells(self, number: int) -> list[Cell]:
        inside = range(self._starts[number], self._starts[number + 1])
        return [cell for cell in self._script.shown_cells if cell.index in inside]

    def _with_cell(self, act: Callable[[Cell], None], rest: str, number: int) -> None:
        """Do something with the cell of a page, or with the one whose number is given."""
        cells = self._cells(number) if not rest else list(self._script.shown_cells)
        cell = next((one for one in cells if not rest or str(one.number) == rest), None)
        if cell is None:
            none = f"No cell {rest} in this lesson."
            self._say(none if rest else "No cell on this page; name its number.")
        elif self._progress.closed_by(cell.index) is not None:
            self._say("Predict first.")
        else:
            act(cell)

    def _run(self, cell: Cell) -> None:
        path = self._files.get(cell.number)
        if path is not None:
            try:
                self._progress.edit(cell, path.read_text("utf-8", "replace").rstrip("\n"))
            except OSError as error:
                self._say(f"{path} cannot be read: {error.strerror}.")
                return
        running = self._bench.start(cell)
        assert running is not None  # one at a time
        try:
            if not wait([running], _PATIENCE).done:
                self._say(f"Cell {cell.number} runs; Ctrl-C stops it.")
            gave = running.result()
        except KeyboardInterrupt:
            self._bench.interrupt()
            gave = running.result()
        self._progress.ran(cell, self._progress.cell(cell).source, gave.printed, gave.error, gave.seconds)
        self._tell(cell, gave)

    def _tell(self, cell: Cell, gave: CellOutput) -> None:
        if gave.earlier:
            self._say(f"First ran cell {', '.join(map(str, gave.earlier))}.")
        if gave.error:
            self._listing(f"Cell {cell.number} printed", gave.printed)
            self._listing(f"Cell {cell.number} stopped", gave.error)
            return
        ran = f"Cell {cell.number} ran in {gave.seconds:.1f} s"
        if gave.printed == (cell.output or ""):
            self._say(f"{ran} and printed the same." if gave.printed else f"{ran}.")
        elif gave.printed:
            self._listing(f"{ran} and printed", gave.printed)
        else:
            self._say(f"{ran} and printed nothing.")

    def _listing(self, label: str, text: str) -> None:
        """Unchanged text, with its length before it and "End of output" after it, as in a printed lesson."""
        rows = len(text.splitlines())
        if rows:
            self._say(f"{label}, {counted(rows, 'line')}:")
            self._console.block(text)
            self._say("End of output")

    def _edit(self, cell: Cell) -> None:
        if cell.number not in self._files:
            try:
                self._files[cell.number] = write_cell(self._progress, cell)
            except CourseError as error:
                self._console.error(error.message, error.help)
                return
        where = f"Cell {cell.number} is in {self._files[cell.number]}: change it there."
        self._say(f"{where} r {cell.number} runs what the file holds.")

    def _undo(self, cell: Cell) -> None:
        self._files.pop(cell.number, None)
        self._progress.edit(cell, cell.source)
        self._say("The lesson's own code is back.")

    # -- tasks -----------------------------------------------------------------------------------------

    def _task(self, number: int) -> Exercise | None:
        block = self._pages[number][-1]
        return self._catalog.exercise(block.id) if isinstance(block, b.Task) else None

    def _with_task(self, command: str, _: str, number: int) -> None:
        """Run a command for the warm-up or the exercise of a page."""
        task = self._task(number)
        if task is None or self._here is None:
            first = "Make a workspace first: course init my-course"
            self._say("No warm-up and no exercise on this page." if task is None else first)
            return
        try:
            again(["warmup" if command == "start" and task.is_warm_up else command, task.id])
        except CourseError as error:
            self._console.error(error.message, error.help)

    # -- ways ------------------------------------------------------------------------------------------

    def _contents(self, _rest: str, _number: int) -> None:
        for section in self._script.sections:
            if section.level == 2:
                page = bisect.bisect_right(self._starts, section.start)
                done = ", done" if self._progress.is_done(section.start, section.end) else ""
                self._say(f"Page {page}: {section.title}{done}")

    def _go(self, rest: str, _number: int) -> int | None:
        if rest.isdecimal() and 0 < int(rest) <= len(self._pages):
            return int(rest) - 1
        self._say(f"g takes the number of a page, 1 to {len(self._pages)}.")
        return None

    def _help(self, _rest: str, _number: int) -> None:
        for word, what in _WORDS:
            self._console.item(word, what)

    def _say(self, words: str) -> None:
        self._console.line(words)

    def _write(self, kind: str, subject: str, data: Mapping[str, object]) -> None:
        if self._here is not None:
            self._kept = self._here.record(kind, subject, dict(data))
            self._here.tell()


def _page(events: Sequence[Event], block: int, starts: Sequence[int]) -> int:
    """The page to continue with: where the student left this or the full-screen reader, or the first page if
    the lesson was read since.

    Args:
        block: the one at the top when the student stopped; below 0 for none.
        starts: the first block of each page, and after the last one the number of blocks.
    """
    last = next((event for event in reversed(events) if event.kind in {"place", "bookmark", "lesson"}), None)
    if last is None or last.kind == "lesson":
        return 0
    if last.kind == "place":  # the form of version 1.2
        page = last.data.get("page", 0)
        return page if isinstance(page, int) and 0 <= page < len(starts) - 1 else 0
    return max(0, bisect.bisect_right(starts, block) - 1)
