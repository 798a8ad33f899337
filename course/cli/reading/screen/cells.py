"""The keys for a lesson's cells: run, stop, change, copy, write; and their results on the page."""

from __future__ import annotations

import contextlib
from typing import Any, ClassVar

from textual.binding import Binding

from course.cli.reading.screen.printing import Item
from course.cli.reading.screen.running import Bench
from course.cli.reading.screen.showing import LessonApp
from course.errors import CourseError
from course.reading.cells import CellOutput
from course.reading.parts import Cell
from course.reading.record import InProgress, Place


class CellsApp(LessonApp):
    """A lesson on the whole screen, whose cells run in place."""

    ALWAYS = LessonApp.ALWAYS | {"stop"}
    BINDINGS: ClassVar[list[Any]] = [
        Binding("ctrl+c", "stop", priority=True, show=False),
        Binding("r", "run_cell", show=False),
        Binding("e", "edit", show=False),
        Binding("u", "undo", show=False),
        Binding("c", "copy", show=False),
        Binding("w", "write_cell", show=False),
    ]
    #: Where the cells of the open lesson run; None until one is in sight.
    _bench: Bench | None = None

    def on_unmount(self) -> None:
        """End what runs."""
        self._end_cells()

    def open(self, lesson_id: str, place: Place | None = None) -> None:
        """Open a lesson where its reader left it, or at a place; a cell that runs in another is ended."""
        if self._opened and lesson_id != self.progress.script.lesson.id:
            self._end_cells()
        super().open(lesson_id, place)

    def _tick(self) -> None:
        super()._tick()
        if self._cell_that_runs is not None:
            self._rebuild(self._cell_that_runs.index)

    def _settle(self, *, choose: bool = True) -> None:
        super()._settle(choose=choose)
        if any(item.kind == "cell" for item in self.page.items()):
            self._at_bench().prepare()

    @property
    def _cell_that_runs(self) -> Cell | None:
        return self._bench.cell if self._bench is not None else None

    def _busy(self) -> tuple[str, str]:
        return self._bench.busy() if self._bench is not None else super()._busy()

    def _is_offered(self, item: Item) -> bool:
        return item.kind == "cell" or super()._is_offered(item)

    def _keys(self) -> str:
        if self._cell_that_runs is not None:
            return "the cell runs   Ctrl-C stop it"
        if self.page.item is not None and self.page.item.kind == "cell":
            return "r run   e change   u undo   c copy   w write   Space on   ? keys"
        return super()._keys()

    def action_stop(self) -> None:
        """Stop the cell that runs; else leave."""
        if self._bench is not None and self._bench.cell is not None:
            self._bench.interrupt()
        else:
            self.action_quit_now()

    def _cell(self) -> Cell | None:
        """The cell at hand: the chosen one, or the first in sight."""
        item = self.page.item
        if item is None or item.kind != "cell":
            item = next((one for one in self.page.items() if one.kind == "cell"), None) or self._cell_ahead()
        if item is None:
            item = self.page.item
            question = self.progress.asked_by(item.block) if item is not None else None
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

            def done(cell: Cell, source: str, gave: CellOutput) -> None:
                with contextlib.suppress(RuntimeError):  # the reader is gone
                    self.call_from_thread(self._took, progress, cell, source, gave)

            self._bench = Bench(progress, done, self._clock)
        return self._bench

    def _took(self, progress: InProgress, cell: Cell, source: str, gave: CellOutput) -> None:
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
        """Show the end of a block, where its output is, unless the reader has moved on."""
        book = self.page.book
        span = book.layout.span(block) if book is not None else None
        top, end = self.page.top, self.page.end()
        if span is not None and span[0] < end < span[1] and top < span[1]:
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

        self.push_screen(Edit(f"Cell {cell.number}", self.progress.cell(cell).source, "run"), done)

    def action_undo(self) -> None:
        """The lesson's own code again."""
        cell = self._cell()
        if cell is not None:
            self.progress.edit(cell, cell.source)
            self._rebuild(cell.index)
            self.say("The lesson's own code is back.")

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
