"""A reader's actions in one lesson: read from the student's record, and written to it as they happen.

Four kinds of events, each one short transaction: "bookmark" (a place in the text), "prediction" (typed or
skipped, and later how it did), "cell" (its code as it ran, and what it gave) and "lesson" (its end was
reached). They are written by a thread of their own: a slow disk must not hold up a key.
"""

from __future__ import annotations

import queue
import threading
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Literal

from course.errors import CourseError
from course.reading.pages import Place
from course.reading.parts import is_unseen, words_of

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence
    from datetime import datetime

    from course.progress.store import Event, Store
    from course.reading.parts import Cell, Question, Script

__all__ = ["JUDGEMENTS", "CellState", "InProgress", "Judgement", "Prediction", "Writer"]

Judgement = Literal["right", "nearly", "wrong"]
JUDGEMENTS: tuple[Judgement, ...] = ("right", "nearly", "wrong")
#: As much of what a cell printed, or a reader predicted, as is kept.
_KEPT = 4000
#: Enough of a block's words to know it again after a lesson was edited.
_WORDS = 60


@dataclass(frozen=True, slots=True)
class Prediction:
    """A reader's prediction; ``text`` is empty if they skipped it.

    Attributes:
        at: when; None if it was not read from a record.
        judged: how the reader says it did, once the answer was open.
    """

    text: str
    at: datetime | None = None
    judged: Judgement | None = None

    @property
    def skipped(self) -> bool:
        return not self.text


@dataclass(frozen=True, slots=True)
class CellState:
    """A cell as its reader has it.

    Attributes:
        source: its code now.
        ran: the code that gave what follows; None if it has not run.
        printed: what it printed.
        error: the traceback, or why it was stopped; empty if it ended by itself.
        seconds: how long it took.
    """

    source: str
    ran: str | None = None
    printed: str = ""
    error: str = ""
    seconds: float = 0.0

    @property
    def edited(self) -> bool:
        """Its code changed since it ran."""
        return self.ran is not None and self.ran != self.source


class Writer:
    """Adds events to a record, one after the other, in a thread of its own.

    Attributes:
        trouble: why something was not recorded; empty while all is well.
    """

    def __init__(self, store: Store | None) -> None:
        self._store = store
        self._queue: queue.Queue[tuple[str, str, Mapping[str, Any]] | None] = queue.Queue()
        self._thread: threading.Thread | None = None
        self.trouble = ""

    def __call__(self, kind: str, subject: str, data: Mapping[str, Any]) -> None:
        """Add an event, soon."""
        if self._store is None:
            return
        if self._thread is None:
            self._thread = threading.Thread(target=self._work, name="record", daemon=True)
            self._thread.start()
        self._queue.put((kind, subject, data))

    def close(self) -> None:
        """Wait until everything is written."""
        if self._thread is not None:
            self._queue.put(None)
            self._thread.join()
            self._thread = None

    def _work(self) -> None:
        assert self._store is not None
        while (event := self._queue.get()) is not None:
            try:
                self._store.append(*event)
            except CourseError as error:
                self.trouble = f"This was not recorded: {error.message} {error.help}"


class InProgress:
    """One lesson in progress.

    Args:
        script: the lesson.
        events: what is recorded about it, oldest first.
        write: called with each new event: kind, subject, data.
        version: of the course's content.

    Attributes:
        place: where the reader was last.
        furthest: the last block that was in sight.
        read: the end was reached once.
    """

    def __init__(
        self,
        script: Script,
        events: Sequence[Event] = (),
        write: Callable[[str, str, Mapping[str, Any]], None] = lambda *_: None,
        version: str = "",
    ) -> None:
        self.script = script
        self._write = write
        self._version = version
        self.place = Place()
        self.furthest = -1
        self.read = False
        self._predictions: dict[str, Prediction] = {}
        self._cells: dict[str, CellState] = {}
        for event in events:
            self._take(event)

    # -- predictions ---------------------------------------------------------------------------------

    def prediction(self, question: Question) -> Prediction | None:
        """The prediction; None if the question was neither answered nor skipped."""
        return self._predictions.get(question.key)

    def closed_by(self, index: int) -> Question | None:
        """The open prediction that keeps a block closed; None if the block is open."""
        question = self.script.question_over(index)
        return question if question is not None and question.key not in self._predictions else None

    def asked_by(self, index: int) -> Question | None:
        """The open prediction that is this block, or keeps it closed; None if there is none."""
        question = self.script.question_at(index)
        return question if question and question.key not in self._predictions else self.closed_by(index)

    def predict(self, question: Question, text: str) -> None:
        """Keep a prediction; an empty text is a skip. The first prediction stays."""
        if question.key not in self._predictions:
            said = text.strip()[:_KEPT].encode("utf-8", "replace").decode()
            self._predictions[question.key] = Prediction(said)
            self._note("prediction", {"key": question.key, "number": question.number, "text": said})

    def judge(self, question: Question, judged: Judgement) -> None:
        """Keep how a prediction did, by the reader's own word."""
        said = self._predictions.get(question.key)
        if said is not None and not said.skipped and said.judged != judged:
            self._predictions[question.key] = replace(said, judged=judged)
            self._note("prediction", {"key": question.key, "number": question.number, "judged": judged})

    # -- cells ---------------------------------------------------------------------------------------

    def cell(self, cell: Cell) -> CellState:
        """A cell's present state."""
        return self._cells.get(cell.key) or CellState(cell.source)

    def edit(self, cell: Cell, source: str) -> None:
        """Change a cell's code; an unchanged one leaves no trace."""
        now = self.cell(cell)
        if source != now.source:
            self._cells[cell.key] = replace(now, source=source)
            self._note("cell", {"key": cell.key, "number": cell.number, "source": source})

    def ran(self, cell: Cell, source: str, printed: str, error: str, seconds: float) -> None:
        """Keep what a run gave."""
        now = self.cell(cell)
        self._cells[cell.key] = CellState(now.source, source, printed, error, seconds)
        data: dict[str, Any] = {"key": cell.key, "number": cell.number, "ran": source}
        data |= {"printed": printed[:_KEPT], "error": error[:_KEPT], "seconds": round(seconds, 3)}
        self._note("cell", data)

    # -- reading -------------------------------------------------------------------------------------

    def at(self, place: Place, furthest: int) -> None:
        """The reader is here now, and saw everything up to a block."""
        if place == self.place and furthest <= self.furthest:
            return
        self.place, self.furthest = place, max(self.furthest, furthest)
        words = "" if place.block < 0 else words_of(self.script.blocks[place.block])[:_WORDS]
        data = {"block": place.block, "part": place.part, "words": words, "furthest": self.furthest}
        self._note("bookmark", data)

    def reached_end(self) -> None:
        """The last line was in sight: the lesson is read."""
        if not self.read:
            self.read = True
            self._note("lesson", {"version": self._version})

    # -- the record ----------------------------------------------------------------------------------

    def _note(self, kind: str, data: Mapping[str, Any]) -> None:
        self._write(kind, self.script.lesson.id, data)

    def _take(self, event: Event) -> None:
        """Take an event of the record; one that no longer fits this lesson is ignored."""
        data, key = event.data, str(event.data.get("key", ""))
        if event.kind == "lesson":
            self.read = True
        elif event.kind == "bookmark":
            self._take_bookmark(data)
        elif event.kind == "prediction" and key in {one.key for one in self.script.questions}:
            said = self._predictions.get(key)
            if said is None:
                self._predictions[key] = Prediction(str(data.get("text", "")), event.at)
            elif data.get("judged") in JUDGEMENTS:
                self._predictions[key] = replace(said, judged=data["judged"])
        elif event.kind == "cell":
            cell = next((one for one in self.script.cells if one.key == key), None)
            if cell is not None:
                self._take_cell(cell, data)

    def _take_cell(self, cell: Cell, data: Mapping[str, Any]) -> None:
        now = self.cell(cell)
        if "source" in data:
            self._cells[cell.key] = replace(now, source=str(data["source"]))
        elif "ran" in data:
            seconds = data.get("seconds", 0.0)
            took = float(seconds) if isinstance(seconds, int | float) else 0.0
            printed, error = str(data.get("printed", "")), str(data.get("error", ""))
            self._cells[cell.key] = CellState(now.source, str(data["ran"]), printed, error, took)

    def _take_bookmark(self, data: Mapping[str, Any]) -> None:
        block, part, words = data.get("block"), data.get("part"), data.get("words")
        if not isinstance(block, int) or not isinstance(part, int | float):
            return
        blocks = self.script.blocks
        if block >= 0 and (block >= len(blocks) or words_of(blocks[block])[:_WORDS] != words):
            # The lesson was edited since: the same words are looked for.
            block = next((i for i, one in enumerate(blocks) if words_of(one)[:_WORDS] == words), -2)
        if block >= -1:
            self.place = Place(block, min(1.0, max(0.0, float(part))))
        far = data.get("furthest")
        if isinstance(far, int):
            self.furthest = max(self.furthest, min(far, len(blocks) - 1))

    def is_done(self, start: int, end: int) -> bool:
        """Whether the blocks of a section were all in sight and no prediction in it is open."""
        asked = [one for one in self.script.questions if start <= one.index < end]
        last = max((i for i in range(start, end) if not is_unseen(self.script.blocks[i])), default=start)
        return last <= self.furthest and all(one.key in self._predictions for one in asked)
