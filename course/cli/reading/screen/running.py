"""Cells that run while their reader reads on: one at a time; a thread waits for their process."""

from __future__ import annotations

import contextlib
import signal
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from time import perf_counter

from course.reading.cells import CellOutput, CellRunner
from course.reading.parts import Cell
from course.reading.record import InProgress


class Bench:
    """Where the cells of one lesson run.

    Args:
        progress: the lesson.
        done: called in the cells' thread with the cell, the code that ran and its result.
        clock: real time, in s.
    """

    def __init__(
        self,
        progress: InProgress,
        done: Callable[[Cell, str, CellOutput], None],
        clock: Callable[[], float] = perf_counter,
    ) -> None:
        self._progress = progress
        self._done = done
        self._clock = clock
        self._runner: CellRunner | None = None
        self._pool: ThreadPoolExecutor | None = None
        self._since = 0.0
        self._stopped = False
        self.cell: Cell | None = None

    def start(self, cell: Cell) -> bool:
        """Run a cell; False if one is running already."""
        if self.cell is not None:
            return False
        self.cell, self._since, self._stopped = cell, self._clock(), False
        self._submit(self._run, cell, self._progress.cell(cell).source)
        return True

    def prepare(self) -> None:
        """Start the process ahead, so that the first cell need not wait for it."""
        if self._pool is None:
            self._submit(self._warm)

    def interrupt(self) -> None:
        """Stop the cell that runs."""
        self._stopped = True
        if self._runner is not None:
            self._runner.interrupt()

    def busy(self) -> tuple[str, str]:
        """The key of the cell that runs and what to say of it; empty if none does."""
        if self.cell is None:
            return "", ""
        return self.cell.key, f"runs, {self._clock() - self._since:.0f} s; Ctrl-C stops it"

    def close(self) -> None:
        """Stop the cell that runs, and end its process."""
        self.interrupt()
        if self._pool is not None:
            # In their own thread: the cells' process dies with the thread that started it.
            self._pool.submit(self._end)
            self._pool.shutdown(wait=True)
            self._pool = None

    def _end(self) -> None:
        from course.isolation.failures import IsolationError

        if self._runner is not None:
            with contextlib.suppress(IsolationError):  # it ended by itself
                self._runner.close()
            self._runner = None

    def _submit(self, what: Callable[..., None], *arguments: object) -> None:
        if self._pool is None:
            from concurrent.futures import ThreadPoolExecutor

            self._pool = ThreadPoolExecutor(1, thread_name_prefix="cells", initializer=_hear_no_ctrl_c)
        self._pool.submit(what, *arguments)

    def _made(self) -> CellRunner:
        if self._runner is None:
            from course.reading.cells import CellRunner

            progress = self._progress
            self._runner = CellRunner(progress.script.cells, lambda one: progress.cell(one).source)
        return self._runner

    def _warm(self) -> None:
        from course.isolation.failures import IsolationError

        with contextlib.suppress(IsolationError):  # the first run says it
            self._made().prepare()

    def _run(self, cell: Cell, source: str) -> None:
        from course.isolation.failures import IsolationError
        from course.reading.cells import STOPPED, CellOutput

        try:
            runner = self._made()
            runner.prepare()
            # A stop while the process is still starting is meant for the cell.
            gave = CellOutput("", STOPPED, 0.0) if self._stopped else runner.run(cell)
        except IsolationError as error:
            gave = CellOutput("", f"The cell could not be run: {error}.", 0.0)
        self.cell = None
        self._done(cell, source, gave)


def _hear_no_ctrl_c() -> None:
    """Ctrl-C on a terminal reaches every process there; those that this thread starts are not meant."""
    if hasattr(signal, "pthread_sigmask"):
        signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
