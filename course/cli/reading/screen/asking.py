"""Boxes over the page: contents, search, a prediction, a cell to edit."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, ClassVar

from rich.text import Text
from textual.app import ComposeResult
from textual.binding import Binding
from textual.containers import Vertical, VerticalScroll
from textual.events import Key
from textual.widgets import Input, OptionList, Static, TextArea
from textual.widgets.option_list import Option

from course.full_screen import Field, InOrder, Overlay


class Predict(Overlay[str]):
    """The question, and a field for the prediction. Dismissed with it, or None."""

    def __init__(self, question: str) -> None:
        super().__init__()
        self._question = question

    def compose(self) -> ComposeResult:
        """The question above the line to type in."""
        with VerticalScroll(classes="box", can_focus=False) as box:
            box.border_title = "Predict first"
            box.border_subtitle = "Enter: keep it and open the answer   Escape: not yet"
            yield Static(Text(self._question))
            yield Static("")
            entry = Field(placeholder="a number with its unit, a choice, a sentence")
            entry.cursor_blink = False
            yield entry

    def on_mount(self) -> None:
        """Ready to type."""
        self.query_one(Input).focus()

    def on_input_submitted(self, event: Input.Submitted) -> None:
        """Take it, if something was typed."""
        if event.value.strip():
            self.close(event.value.strip())


class ChoiceOverlay(Overlay[str]):
    """A list to choose from. Dismissed with the key of what was chosen, or None."""

    BINDINGS: ClassVar[list[Any]] = [
        Binding("q,t", "leave", show=False),
        Binding("j", "down", show=False),
        Binding("k", "up", show=False),
    ]

    def __init__(self, title: str, options: Sequence[tuple[str, str]], at: str = "") -> None:
        super().__init__()
        self._title, self._options, self._at = title, options, at

    def compose(self) -> ComposeResult:
        """The list; an option without a key is a heading."""
        with Vertical(classes="box") as box:
            box.border_title, box.border_subtitle = self._title, "Enter: go there   Escape: back"
            yield OptionList(
                *(Option(Text(words), id=key or None, disabled=not key) for key, words in self._options)
            )

    def on_mount(self) -> None:
        """At the place where the reader is."""
        chooser = self.query_one(OptionList)
        keys = [key for key, _ in self._options]
        if self._at in keys:
            chooser.highlighted = keys.index(self._at)
        chooser.focus()

    def on_option_list_option_selected(self, event: OptionList.OptionSelected) -> None:
        """Take it."""
        self.close(event.option.id)

    def action_down(self) -> None:
        """Further down."""
        self.query_one(OptionList).action_cursor_down()

    def action_up(self) -> None:
        """Further up."""
        self.query_one(OptionList).action_cursor_up()


class Find(Overlay[str]):
    """Words to look for, and where they are. Dismissed with the key of a hit, or None.

    Args:
        search: (key, what to show) of each hit for some words.
    """

    def __init__(self, search: Callable[[str], list[tuple[str, str]]]) -> None:
        super().__init__()
        self._search = search

    def compose(self) -> ComposeResult:
        """A line to type in, and the hits below it."""
        with Vertical(classes="box") as box:
            box.border_title = "Search"
            box.border_subtitle = "Enter: look   Escape: back"
            entry = Field(placeholder="words, in this lesson and in all")
            entry.cursor_blink = False
            yield entry
            yield OptionList()

    def on_mount(self) -> None:
        """Ready to type."""
        self.query_one(OptionList).display = False
        self.query_one(Input).focus()

    def on_input_submitted(self, event: Input.Submitted) -> None:
        """Look."""
        hits = self._search(event.value)
        chooser = self.query_one(OptionList)
        chooser.clear_options()
        chooser.display = True
        if not hits:
            chooser.add_option(Option("Nothing.", disabled=True))
            return
        chooser.add_options([Option(Text(words), id=key) for key, words in hits])
        chooser.highlighted = 0
        chooser.focus()

    def on_option_list_option_selected(self, event: OptionList.OptionSelected) -> None:
        """Take it."""
        self.close(event.option.id)


class _Code(InOrder, TextArea):
    """A field for Python: Enter indents the next line as Python's own editors do."""

    BINDINGS: ClassVar[list[Any]] = [
        Binding("ctrl+home", "to_start", show=False),
        Binding("ctrl+end", "to_end", show=False),
        Binding("escape", "screen.keep", show=False),
        Binding("ctrl+r,f5", "screen.run", show=False),
        Binding("ctrl+d", "screen.drop", show=False),
    ]

    def action_to_start(self) -> None:
        """The first line."""
        self.move_cursor((0, 0))

    def action_to_end(self) -> None:
        """The end of the last line."""
        self.move_cursor(self.document.end)

    def _on_key(self, event: Key) -> None:  # type: ignore[override]
        if event.key != "enter":
            return  # Textual goes on with those of its bases
        event.stop()
        event.prevent_default()
        start, end = self.selection
        (row, column), _ = sorted((start, end))
        before = self.document.get_line(row)[:column]
        indent = before[: len(before) - len(before.lstrip())]
        if before.partition("#")[0].rstrip().endswith(":"):
            indent += " " * self.indent_width
        self._replace_via_keyboard(f"\n{indent}", start, end)


class Edit(Overlay[tuple[str, bool]]):
    """Code to change. Dismissed with it and whether to run or check it, or None to leave it as it was.

    Args:
        act: what Ctrl-R does after keeping it: "run" for a cell, "check" for a task's file.
        line: where to begin.
    """

    DEFAULT_CSS = """
    Edit TextArea, Edit TextArea:focus { height: 1fr; border: none; padding: 0; }
    Edit > .box { height: 96%; }
    """
    BINDINGS: ClassVar[list[Any]] = [
        Binding("escape", "keep", show=False),
        Binding("ctrl+r,f5", "run", show=False),
        Binding("ctrl+d", "drop", show=False),
    ]

    def __init__(self, title: str, source: str, act: str, line: int = 1) -> None:
        super().__init__()
        self._title, self._source, self._act, self._line = title, source, act, line
        self._asked = False

    def compose(self) -> ComposeResult:
        """The code, with the keys that end editing below it."""
        with Vertical(classes="box") as box:
            box.border_title = self._title
            box.border_subtitle = self._keys()
            area = _Code(self._source, tab_behavior="indent", show_line_numbers=True)
            area.cursor_blink = False
            yield area

    def on_mount(self) -> None:
        """Ready to type, with the line to change in sight."""
        area = self.query_one(TextArea)
        area.focus()
        area.move_cursor((self._line - 1, 0), center=True)

    def action_keep(self) -> None:
        """Keep the code as it is now."""
        self.close((self.query_one(TextArea).text, False))

    def action_run(self) -> None:
        """Keep it, and run or check it."""
        self.close((self.query_one(TextArea).text, True))

    def action_drop(self) -> None:
        """As it was; where something was changed, at the second press."""
        if self._asked or self.query_one(TextArea).text == self._source:
            self.close(None)
        else:
            self._ask(asked=True)

    def on_text_area_changed(self) -> None:
        """Who goes on typing does not drop anything."""
        if self._asked:
            self._ask(asked=False)

    def _ask(self, *, asked: bool) -> None:
        self._asked = asked
        self.query_one(".box").border_subtitle = self._keys()

    def _keys(self) -> str:
        if self._asked:
            return "Ctrl-D again: drop the changes   Escape: keep"
        return f"Ctrl-R: keep and {self._act}   Escape: keep   Ctrl-D: drop the changes"
