"""A reader's actions in one lesson: read from the student's record, and written to it as they happen.

Four kinds of events, each one short transaction: "bookmark" (a place in the text), "prediction" (typed or
skipped, and later how it did), "cell" (its code as it ran, and what it gave) and "lesson" (its end was
reached). They are written by a thread of their own: a slow disk must not hold up a key.
"""

import queue
import threading
from bisect import bisect_right
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from typing import Any, Literal

from course.printable import beginning
from course.progress.store import Event, Store
from course.progress.workspace import Recorder
from course.reading.parts import Cell, Question, Script, is_unseen, words_of

# ---
# Screens of a given height out of rows of any width, and a place in the text that outlives both.
#
# A row is one line of the screen. The layout says for each row which block it belongs to, whether it is
# blank, and whether a screen may begin with it. Everything here is arithmetic on that.


#: A screen is cut short to keep something whole if at least this much of it stays filled, or this little
#: where what is kept whole fits on the next screen.
_FILLED, _LEAST = 0.5, 0.2


@dataclass(frozen=True, slots=True)
class Row:
    """Facts about one line.

    Attributes:
        block: index of the block it belongs to; -1 for the head of the lesson.
        blank: nothing is on it.
        joined: it belongs to the row above; no screen should begin with it.
        fresh: it takes the rows above as answered; a screen always begins with it.
    """

    block: int
    blank: bool = False
    joined: bool = False
    fresh: bool = False


@dataclass(frozen=True, slots=True)
class Place:
    """Where a reader is, in the text and not on a page.

    Attributes:
        block: index of the block at the top of the screen; -1 is the head of the lesson.
        part: how far into the block, from 0 to 1.
    """

    block: int = -1
    part: float = 0.0


class Layout:
    """A lesson laid out for one width, cut into screens of one height.

    Args:
        rows: every line, in order.
        height: lines on a screen.

    Attributes:
        starts: the first row of each screen.
    """

    def __init__(self, rows: Sequence[Row], height: int) -> None:
        self.rows = rows
        self.height = max(1, height)
        self._spans: dict[int, tuple[int, int]] = {}
        for number, row in enumerate(rows):
            first, _ = self._spans.get(row.block, (number, number))
            self._spans[row.block] = (first, number + 1)
        self.starts = self._cut()

    def __len__(self) -> int:
        return len(self.rows)

    @property
    def last(self) -> int:
        """The first row of the last screen."""
        return self.starts[-1]

    def end_of(self, top: int) -> int:
        """The row after the last one of a screen that begins with row ``top``."""
        end = top + self.height
        fresh = (row for row in range(top + 1, min(end, len(self.rows))) if self.rows[row].fresh)
        if (first_fresh := next(fresh, None)) is not None:
            return first_fresh
        if end >= len(self.rows):
            return len(self.rows)
        for cut in range(end, top + int(self.height * _LEAST), -1):
            if not self.rows[cut].joined:
                first, last = self._spans[self.rows[cut].block]
                fits = last - first <= self.height + 1  # a blank line above it is left out
                return cut if cut - top >= self.height * _FILLED or fits else end
        return end

    def next(self, top: int) -> int:
        """Where the screen after the one at ``top`` begins; the same row at the end."""
        end = self._begin(self.end_of(top))
        return end if end < len(self.rows) else top

    def previous(self, top: int) -> int:
        """Where the screen before the one at ``top`` begins."""
        return next((start for start in reversed(self.starts) if start < top), 0)

    def number(self, top: int) -> int:
        """Which screen a row is on, 1 first."""
        return bisect_right(self.starts, max(0, top))

    def place(self, top: int) -> Place:
        """The place in the text of the row at the top."""
        if not self.rows:
            return Place()
        block = self.rows[min(top, len(self.rows) - 1)].block
        first, end = self._spans[block]
        return Place(block, round((top - first) / (end - first), 4))

    def row(self, place: Place) -> int:
        """The row that a place is on here; the nearest there is if its block is not shown."""
        if place.block in self._spans:
            first, end = self._spans[place.block]
            return min(end - 1, first + round(place.part * (end - first)))
        before = [first for block, (first, _) in self._spans.items() if block < place.block]
        return max(before, default=0)

    def span(self, block: int) -> tuple[int, int] | None:
        """First row of a block and the row after its last; None if it is not shown."""
        return self._spans.get(block)

    def _begin(self, row: int) -> int:
        """A screen does not begin with blank lines."""
        while row < len(self.rows) and self.rows[row].blank:
            row += 1
        return row

    def _cut(self) -> list[int]:
        starts = [self._begin(0)] if self.rows else [0]
        while (following := self.next(starts[-1])) > starts[-1]:
            starts.append(following)
        return starts


Judgement = Literal["right", "nearly", "wrong"]
JUDGEMENTS: tuple[Judgement, ...] = ("right", "nearly", "wrong")
#: As much of what a cell printed, or a reader predicted, as is kept.
_KEPT = 4000
#: Enough of a block's words to know it again after a lesson was edited.
_WORDS = 60


@dataclass(frozen=True, slots=True)
class Prediction:
    """A reader's prediction.

    Attributes:
        lesson: where it was asked.
        key: of the question, as ``Question.key``.
        text: what they said; empty if they skipped it.
        at: when, in UTC.
        judged: how it did, by the reader's own word once the answer was open; None if that was not said.
    """

    lesson: str
    key: str
    text: str
    at: datetime
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


class Writer:
    """Adds events to a record, one after the other, in a thread of its own."""

    def __init__(self, store: Store | None) -> None:
        self._record = Recorder(store)
        self._queue: queue.Queue[tuple[str, str, Mapping[str, Any]] | threading.Event | None] = queue.Queue()
        self._thread: threading.Thread | None = None

    @property
    def trouble(self) -> str:
        """Why something was not recorded; empty while all is well."""
        return self._record.trouble

    def __call__(self, kind: str, subject: str, data: Mapping[str, Any]) -> None:
        """Add an event, soon."""
        if self._record.store is None:
            return
        if self._thread is None:
            self._thread = threading.Thread(target=self._work, name="record", daemon=True)
            self._thread.start()
        self._queue.put((kind, subject, data))

    def kept(self, patience: float) -> bool:
        """Whether the event added last is in the record, as far as that is known within this time, in s."""
        if self._thread is None:
            return False
        reached = threading.Event()
        self._queue.put(reached)
        return reached.wait(patience) and self._record.kept

    def close(self) -> None:
        """Wait until everything is written."""
        if self._thread is not None:
            self._queue.put(None)
            self._thread.join()
            self._thread = None

    def _work(self) -> None:
        while (event := self._queue.get()) is not None:
            if isinstance(event, threading.Event):
                event.set()
            else:
                self._record(*event)


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
        # What was recorded of a longer lesson, which this one was part of, is of this one now.
        said = [one for one in events if one.kind == "prediction"]
        mine = predictions_of(replace(one, subject=script.lesson.id) for one in said)
        self._predictions = {one.key: one for one in mine}
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

    def answered_at(self, index: int) -> tuple[Question, Prediction] | None:
        """The prediction that a block answers, with what its reader said; None if that was nothing."""
        question = self.script.answered_at(index)
        said = self.prediction(question) if question is not None else None
        return (question, said) if question and said and not said.skipped else None

    def predict(self, question: Question, text: str) -> None:
        """Keep a prediction; an empty text is a skip. The first prediction stays."""
        if question.key not in self._predictions:
            said, lesson = text.strip()[:_KEPT].encode("utf-8", "replace").decode(), self.script.lesson.id
            self._predictions[question.key] = Prediction(lesson, question.key, said, datetime.now(UTC))
            self._note("prediction", {"key": question.key, "number": question.number, "text": said})

    def judge(self, question: Question, judged: Judgement) -> None:
        """Keep how a prediction did, by the reader's own word."""
        said = self._predictions.get(question.key)
        if said is not None and not said.skipped and said.judged != judged:
            self._predictions[question.key] = replace(said, judged=judged)
            self._note("prediction", {"key": question.key, "number": question.number, "judged": judged})

    # -- cells ---------------------------------------------------------------------------------------

    def cell(self, cell: Cell) -> CellState:
        return self._cells.get(cell.key) or CellState(cell.source)

    def edit(self, cell: Cell, source: str) -> None:
        """Change a cell's code; an unchanged one leaves no trace."""
        now = self.cell(cell)
        if source != now.source:
            self._cells[cell.key] = replace(now, source=source)
            self._note("cell", {"key": cell.key, "number": cell.number, "source": source})

    def ran(self, cell: Cell, source: str, printed: str, error: str, seconds: float) -> None:
        now = self.cell(cell)
        self._cells[cell.key] = CellState(now.source, source, printed, error, seconds)
        data: dict[str, Any] = {"key": cell.key, "number": cell.number, "ran": source}
        data |= {"printed": beginning(printed, _KEPT), "error": error[:_KEPT], "seconds": round(seconds, 3)}
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
            self._note("lesson", {"version": self._version, "blocks": len(self.script.blocks)})

    # -- the record ----------------------------------------------------------------------------------

    def _note(self, kind: str, data: Mapping[str, Any]) -> None:
        self._write(kind, self.script.lesson.id, data)

    def _take(self, event: Event) -> None:
        """Take an event of the record; one that no longer fits this lesson is ignored."""
        data, key = event.data, str(event.data.get("key", ""))
        if event.kind == "lesson":
            self.read = True
            if event.subject != self.script.lesson.id:  # all of a longer lesson, which this one was part of
                self.furthest = len(self.script.blocks) - 1
        elif event.kind == "bookmark":
            self._take_bookmark(data)
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


# ---
# A student's predictions, in one lesson or in all, and how good they were: read from the reader's record.


def predictions_of(events: Iterable[Event]) -> tuple[Prediction, ...]:
    """The predictions that events of kind "prediction" tell of, in the order they were made.

    The first prediction for a question stays; the last judgement counts.
    """
    found: dict[tuple[str, str], Prediction] = {}
    for event in events:
        if event.kind != "prediction":
            continue
        data, place = event.data, (event.subject, str(event.data.get("key", "")))
        said, judged = found.get(place), data.get("judged")
        if said is None:
            found[place] = Prediction(*place, str(data.get("text", "")), event.at)
        elif judged in JUDGEMENTS and said.text:
            found[place] = replace(said, judged=judged)
    return tuple(found.values())


def tally(predictions: Iterable[Prediction]) -> dict[str, int]:
    """How many of them went which way: ``unjudged`` were made and never judged; ``said`` were not skipped."""
    counts = dict.fromkeys((*JUDGEMENTS, "unjudged", "skipped", "said"), 0)
    for one in predictions:
        counts["skipped" if not one.text else one.judged or "unjudged"] += 1
        counts["said"] += bool(one.text)
    return counts


# ---
# Words in one lesson, or in all of them.


#: Characters shown on each side of what was found.
_BEFORE, _AFTER = 24, 48


@dataclass(frozen=True, slots=True)
class Hit:
    """A block that holds the words: where it is, and what stands round them."""

    block: int
    excerpt: str


def find(progress: InProgress, wanted: str) -> Iterator[Hit]:
    """Where words occur in a lesson, a block at most once; capitals do not matter.

    What stands above its first block is found at -1. Text that may answer an open prediction is not searched.
    """
    script, lesson = progress.script, progress.script.lesson
    needle = " ".join(wanted.split()).casefold()
    if not needle:
        return
    shown = [(-1, " ".join((lesson.title, lesson.summary, *lesson.objectives)))]
    shown += [
        (index, words_of(block))
        for index, block in enumerate(script.blocks)
        if progress.closed_by(index) is None or not script.gives_away(index)
    ]
    for index, words in shown:
        text = " ".join(words.split())
        at = text.casefold().find(needle)
        if at >= 0:
            first, last = max(0, at - _BEFORE), at + len(needle) + _AFTER
            excerpt = ("…" if first else "") + text[first:last] + ("…" if last < len(text) else "")
            yield Hit(index, excerpt)


def unless_hidden(*lessons: InProgress) -> str:
    """Ends the sentence that words are nowhere in these lessons: open predictions hide some of their text."""
    hidden = sum(
        any(one.script.gives_away(index) for index in range(question.index + 1, question.end))
        for one in lessons
        for question in one.script.questions
        if one.prediction(question) is None
    )
    if not hidden:
        return "."
    which = "the open prediction" if hidden == 1 else f"one of {hidden} open predictions"
    return f", unless behind {which}."
