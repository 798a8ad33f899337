"""The keys for a lesson's warm-ups and exercises: start, change, check, hint. Each save is checked."""

from __future__ import annotations

import contextlib
from typing import Any, ClassVar

from textual.binding import Binding

from course.catalog.blocks import Task
from course.cli.reading.screen.cells import CellsApp
from course.cli.reading.screen.printing import Item
from course.cli.reading.screen.tasks import hint_is_named, line_to_mend
from course.errors import CourseError

_BUSY = "Something is being checked already."


class TasksApp(CellsApp):
    """A lesson on the whole screen, whose cells run and whose tasks are done in place."""

    BINDINGS: ClassVar[list[Any]] = [Binding("h", "hint", show=False)]

    def on_mount(self) -> None:
        """Receive the results of the checks."""
        self._practice.changed = self._task_changed

    def _tick(self) -> None:
        super()._tick()
        # A file that is saved during a check is checked after it.
        if self._practice.possible and not self._practice.busy and len(self.screen_stack) == 1:
            for item in self.page.items():
                # The student saved it in an editor.
                if item.kind == "task" and self._practice.was_saved(item.target):
                    self._practice.check(item.target)
                    self._rebuild(item.block)

    def _is_offered(self, item: Item) -> bool:
        if item.kind == "task":
            return not self._practice.of(item.target).done
        return super()._is_offered(item)

    def _keys(self) -> str:
        item = self.page.item
        if item is None or item.kind != "task":
            return super()._keys()
        if not self._practice.possible:
            return "done in a workspace   Space on   ? keys"
        if not self._practice.of(item.target).file:
            return "Enter start it   Space on   ? keys"
        if busy := self._practice.of(item.target).busy:  # in a low window its own line may be out of sight
            return f"{busy} ...   Space on   ? keys"
        hint = "h hint   " if hint_is_named(self._practice.of(item.target)) else ""
        return f"r check   e edit   {hint}Space on   ? keys"

    @property
    def _at_hand(self) -> Item | None:
        """The task at hand."""
        item = self.page.item
        return item if item is not None and item.kind == "task" else None

    def action_run_cell(self) -> None:
        """Check the task at hand, or run the cell."""
        if self._at_hand is None:
            super().action_run_cell()
        else:
            self._do(self._at_hand)

    def action_edit(self) -> None:
        """Change the file of the task at hand, or the cell."""
        if self._at_hand is None:
            super().action_edit()
        else:
            self._edit(self._at_hand)

    def action_hint(self) -> None:
        """The hint that is due at the task at hand; all keys elsewhere."""
        item = self._at_hand
        if item is None:
            self.action_help()
        elif not self._practice.of(item.target).file:
            self._do(item)
        elif self._practice.hint(item.target):
            self._show_task(item.target)
        else:
            self.say(_BUSY)

    def action_help(self) -> None:
        """All keys; the class above knows them."""

    def _do(self, item: Item) -> None:
        """Start a task, or check it."""
        practice = self._practice
        if not practice.possible:
            self.say("Make a workspace first: course init my-course")
        elif practice.of(item.target).file:
            if not practice.check(item.target):
                self.say(_BUSY)
        else:
            try:
                practice.start(item.target)
            except CourseError as error:
                self.say(error.message)
        self._show_task(item.target)

    def _edit(self, item: Item) -> None:
        """Change the file of a task here; a missing one is written first."""
        practice = self._practice
        if not practice.of(item.target).file:
            self._do(item)
            if not practice.of(item.target).file:
                return
        from course.cli.reading.screen.asking import Edit

        def done(result: tuple[str, bool] | None) -> None:
            if result is None:
                return
            source, check = result
            try:
                practice.write(item.target, source)
            except CourseError as error:
                self.say(error.message)
                return
            if check:
                practice.check(item.target)
            self._rebuild(item.block)

        now, source = practice.of(item.target), practice.source(item.target)
        self.push_screen(Edit(now.file, source, "check", line_to_mend(now, source)), done)

    def _task_changed(self, name: str) -> None:
        """A task's state has changed (called from another thread)."""
        with contextlib.suppress(RuntimeError):  # the reader is gone
            self.call_from_thread(self._show_answer, name)

    def _show_answer(self, name: str) -> None:
        self.hush()
        self._show_task(name)

    def _show_task(self, name: str) -> None:
        index = self.progress.script.task(name)
        if isinstance(self.progress.script.blocks[index], Task):
            self._rebuild(index)
            self._bring_to_sight(index)
            self._say_round()
