"""Boxes over the page: a prediction, contents, search, code to edit, the keys."""

from collections.abc import Callable, Sequence
from typing import Any, ClassVar

from rich.table import Table
from rich.text import Text
from textual.app import ComposeResult
from textual.binding import Binding
from textual.containers import Vertical, VerticalScroll
from textual.events import Key
from textual.widgets import Input, OptionList, Static, TextArea
from textual.widgets.option_list import Option

from course.errors import CourseError
from course.full_screen import Field, InOrder, Overlay

#: Said below code that is changed.
_DROP = "Ctrl-D again: drop the changes   Escape: keep"
_LEAVE = "Ctrl-C again or Escape: keep   Nothing is selected"
_COPIED = "Copied if your terminal allows it   Escape: keep"

_HELP = (
    ("Space, PgDn", "next screen; at the end of the lesson: what is next"),
    ("b, PgUp", "the screen before"),
    ("↓ ↑, j k, the wheel", "a line on or back"),
    ("g G, Home End", "the first screen, the last"),
    ("Tab, Shift-Tab", "the next thing that keys act on: a prediction, a cell, a figure, a link"),
    ("Enter", "predict; run the cell; start or check the task; open the figure; follow the link"),
    ("s", "skip a prediction; that is kept, too"),
    ("1 2 3", "below an answer: you were right, nearly right, wrong"),
    ("r", "run the cell, and before it what it needs; check the warm-up or the exercise"),
    ("Ctrl-C", "stop the cell that runs; else leave. Your place is kept"),
    ("e", "change the cell or the task's file; Ctrl-R there runs or checks it, Ctrl-C copies"),
    ("h", "at a task its next hint; elsewhere these keys"),
    ("u", "put the lesson's own code back into the cell"),
    ("c", "copy the cell, or a command, to the clipboard of your terminal"),
    ("w", "write the cell into a file here"),
    ("o", "open the figure in the system's viewer"),
    ("t", "contents, with what is done"),
    ("/", "search in this lesson and in all"),
    ("n", "the next place that the search finds"),
    ("Backspace", "back to where a link was followed"),
    ("q", "leave; `course lesson` comes back to this line"),
)


def keys_table(width: int) -> Table:
    """All keys, on a screen of this many columns."""
    grid = Table.grid(padding=(0, 2, 0, 0))
    grid.add_column(no_wrap=width >= 60)
    grid.add_column()
    for key, what in _HELP:
        grid.add_row(Text(key, style="bold"), Text(what))
    return grid


class Predict(Overlay[str]):
    """The question, and a field for the prediction. Dismissed with it, or None."""

    below = "Enter: keep it and open the answer   Escape: not yet"

    def __init__(self, question: str) -> None:
        super().__init__()
        self._question = question

    def compose(self) -> ComposeResult:
        with VerticalScroll(classes="box", can_focus=False) as box:
            box.border_title = "Predict first"
            yield Static(Text(self._question))
            yield Static("")
            entry = Field(placeholder="a number with its unit, a choice, a sentence")
            entry.cursor_blink = False
            yield entry

    def on_mount(self) -> None:
        self.query_one(Input).focus()

    def on_input_submitted(self, event: Input.Submitted) -> None:
        if event.value.strip():
            self.close(event.value.strip())


class _Chooser(Overlay[str]):
    """Has a list to choose from. Dismissed with the key of what was chosen, or None."""

    def on_option_list_option_selected(self, event: OptionList.OptionSelected) -> None:
        self.close(event.option.id)


class Choice(_Chooser):
    """A list, with the place in it where the reader is; an option without a key is a heading."""

    below = "Enter: go there   Escape: back"
    BINDINGS: ClassVar[list[Any]] = [
        Binding("q,t", "leave", show=False),
        Binding("j", "focused.cursor_down", show=False),
        Binding("k", "focused.cursor_up", show=False),
    ]

    def __init__(self, title: str, options: Sequence[tuple[str, str]], at: str = "") -> None:
        super().__init__()
        self._title, self._options, self._at = title, options, at

    def compose(self) -> ComposeResult:
        with Vertical(classes="box") as box:
            box.border_title = self._title
            yield OptionList(
                *(Option(Text(words), id=key or None, disabled=not key) for key, words in self._options)
            )

    def on_mount(self) -> None:
        chooser = self.query_one(OptionList)
        keys = [key for key, _ in self._options]
        if self._at in keys:
            chooser.highlighted = keys.index(self._at)
        chooser.focus()


class Find(_Chooser):
    """Words to look for, and where they are.

    Args:
        search: (key, what to show) of each hit for some words; one without a key says that there is none.
    """

    below = "Enter: look   Escape: back"

    def __init__(self, search: Callable[[str], list[tuple[str, str]]]) -> None:
        super().__init__()
        self._search = search

    def compose(self) -> ComposeResult:
        with Vertical(classes="box") as box:
            box.border_title = "Search"
            entry = Field(placeholder="words, in this lesson and in all")
            entry.cursor_blink = False
            yield entry
            yield OptionList()

    def on_mount(self) -> None:
        self.query_one(OptionList).display = False
        self.query_one(Input).focus()

    def on_input_submitted(self, event: Input.Submitted) -> None:
        hits = self._search(event.value)
        chooser = self.query_one(OptionList)
        chooser.clear_options()
        chooser.display = True
        chooser.add_options([Option(Text(words), id=key or None, disabled=not key) for key, words in hits])
        if any(key for key, _ in hits):
            chooser.highlighted = 0
            chooser.focus()


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
        self.move_cursor((0, 0))

    def action_to_end(self) -> None:
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


class Edit(Overlay[bool]):
    """Code to change. Dismissed with whether to run or check it once it is kept, or None if it was dropped.

    Args:
        keep: takes the code; raises a ``CourseError`` where it cannot be kept.
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

    def __init__(self, title: str, source: str, keep: Callable[[str], None], act: str, line: int = 1) -> None:
        super().__init__()
        self._title, self._source, self._keep, self._act, self._line = title, source, keep, act, line
        self._area = _Code(source, tab_behavior="indent", show_line_numbers=True)
        self._area.cursor_blink = False
        self.below = self._keys

    def compose(self) -> ComposeResult:
        with Vertical(classes="box") as box:
            box.border_title = self._title
            yield self._area

    def on_mount(self) -> None:
        """Ready to type, with the line to change in sight."""
        self._area.focus()
        self._area.move_cursor((self._line - 1, 0), center=True)

    def kept(self) -> bool:
        """Keep the code as it is now; False, with the reason below it, where that is not possible."""
        try:
            self._keep(self._area.text)
        except CourseError as error:
            self._tell(error.message)
            return False
        return True

    def keep_changes(self) -> bool:
        """As ``kept``, for a reader who leaves without a word: what was not changed is left alone."""
        return self._area.text == self._source or self.kept()

    def action_keep(self) -> None:
        if self.kept():
            self.close(False)

    def action_run(self) -> None:
        if self.kept():
            self.close(True)

    def action_drop(self) -> None:
        """As it was; where something was changed, at the second press."""
        if self.below == _DROP or self._area.text == self._source:
            self.close(None)
        else:
            self._tell(_DROP)

    def copied(self) -> bool:
        """Copy what is selected; False if nothing is."""
        if not self._area.selected_text:
            return False
        self.app.copy_to_clipboard(self._area.selected_text)
        self._tell(_COPIED)
        return True

    def leave(self) -> None:
        """What Ctrl-C does where nothing is selected: keep the code and close, at the second press."""
        if self.below == _LEAVE:
            self.action_keep()
        else:
            self._tell(_LEAVE)

    def on_text_area_changed(self) -> None:
        """Who goes on typing does not drop anything."""
        if self.below != self._keys:
            self._tell(self._keys)

    def _tell(self, words: str) -> None:
        self.below = words
        self.fit_below()

    @property
    def _keys(self) -> str:
        return f"Ctrl-R: keep, {self._act}   Escape: keep   Ctrl-D: drop the changes"
