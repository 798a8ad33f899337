"""What is laid over the page: contents, search, a prediction, a cell to edit, help."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar

from rich.text import Text
from textual.binding import Binding
from textual.containers import Vertical, VerticalScroll
from textual.screen import ModalScreen
from textual.widgets import Input, OptionList, Static, TextArea
from textual.widgets.option_list import Option

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from textual.app import ComposeResult

__all__ = ["Choose", "Edit", "Find", "Predict", "Tell"]

_BOX = """
%(name)s { align: center middle; background: black 40%%; }
%(name)s > .box {
    width: 96%%; max-width: 84; height: auto; max-height: 96%%;
    border: round $primary; padding: 0 1; background: $surface; scrollbar-size-vertical: 1;
}
%(name)s OptionList { height: auto; max-height: 80vh; border: none; background: $surface; padding: 0; }
%(name)s OptionList:focus { border: none; }
%(name)s Input { width: 100%%; }
"""


def _css(name: str) -> str:
    return _BOX % {"name": name}


class Predict(ModalScreen[str | None]):
    """The question, and a place for what the reader expects. Dismissed with it, or None."""

    DEFAULT_CSS = _css("Predict")
    BINDINGS: ClassVar[list[Any]] = [Binding("escape", "leave", show=False)]

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
            entry = Input(placeholder="a number with its unit, a choice, a sentence")
            entry.cursor_blink = False
            yield entry

    def on_mount(self) -> None:
        """Ready to type."""
        self.query_one(Input).focus()

    def on_input_submitted(self, event: Input.Submitted) -> None:
        """Take it, if something was typed."""
        if event.value.strip():
            self.dismiss(event.value.strip())

    def action_leave(self) -> None:
        """Back to the page."""
        self.dismiss(None)


class Choose(ModalScreen[str | None]):
    """A list to choose from. Dismissed with the key of what was chosen, or None."""

    DEFAULT_CSS = _css("Choose")
    BINDINGS: ClassVar[list[Any]] = [
        Binding("escape,q,t", "leave", show=False),
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
        self.dismiss(event.option.id)

    def action_leave(self) -> None:
        """Back to the page."""
        self.dismiss(None)

    def action_down(self) -> None:
        """Further down."""
        self.query_one(OptionList).action_cursor_down()

    def action_up(self) -> None:
        """Further up."""
        self.query_one(OptionList).action_cursor_up()


class Find(ModalScreen[str | None]):
    """Words to look for, and where they are. Dismissed with the key of a hit, or None.

    Args:
        search: (key, what to show) of each hit for some words.
    """

    DEFAULT_CSS = _css("Find")
    BINDINGS: ClassVar[list[Any]] = [Binding("escape", "leave", show=False)]

    def __init__(self, search: Callable[[str], list[tuple[str, str]]]) -> None:
        super().__init__()
        self._search = search

    def compose(self) -> ComposeResult:
        """A line to type in, and the hits below it."""
        with Vertical(classes="box") as box:
            box.border_title = "Search"
            box.border_subtitle = "Enter: look   Escape: back"
            entry = Input(placeholder="words, in this lesson and in all")
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
        self.dismiss(event.option.id)

    def action_leave(self) -> None:
        """Back to the page."""
        self.dismiss(None)


class Edit(ModalScreen[tuple[str, bool] | None]):
    """A cell's code. Dismissed with the code and whether to run it, or None to leave it as it was."""

    DEFAULT_CSS = _css("Edit") + "Edit TextArea { height: 1fr; border: none; } Edit > .box { height: 96%; }"
    BINDINGS: ClassVar[list[Any]] = [
        Binding("escape", "keep", show=False, priority=True),
        Binding("ctrl+r,f5", "run", show=False, priority=True),
        Binding("ctrl+d", "drop", show=False, priority=True),
    ]

    def __init__(self, title: str, source: str) -> None:
        super().__init__()
        self._title, self._source = title, source

    def compose(self) -> ComposeResult:
        """The code, with the keys that end editing below it."""
        with Vertical(classes="box") as box:
            box.border_title = self._title
            box.border_subtitle = "Ctrl-R: keep and run   Escape: keep   Ctrl-D: drop the changes"
            area = TextArea(self._source, tab_behavior="indent", show_line_numbers=True)
            area.cursor_blink = False
            yield area

    def on_mount(self) -> None:
        """Ready to type."""
        self.query_one(TextArea).focus()

    def action_keep(self) -> None:
        """Keep the code as it is now."""
        self.dismiss((self.query_one(TextArea).text, False))

    def action_run(self) -> None:
        """Keep it and run it."""
        self.dismiss((self.query_one(TextArea).text, True))

    def action_drop(self) -> None:
        """As it was."""
        self.dismiss(None)


class Tell(ModalScreen[str | None]):
    """Something to read. Dismissed with the key that closed it, if it was one of ``keys``."""

    DEFAULT_CSS = _css("Tell")
    BINDINGS: ClassVar[list[Any]] = [Binding("escape,enter,q,question_mark,f1", "leave", show=False)]

    def __init__(self, title: str, shown: Any, keys: Sequence[str] = (), hint: str = "Escape: back") -> None:
        super().__init__()
        self._title, self._shown, self._keys, self._hint = title, shown, tuple(keys), hint

    def compose(self) -> ComposeResult:
        """The page, scrolled with arrows and the wheel."""
        with VerticalScroll(classes="box") as box:
            box.border_title, box.border_subtitle = self._title, self._hint
            yield Static(self._shown)

    def on_mount(self) -> None:
        """Arrows scroll at once."""
        self.query_one(VerticalScroll).focus()

    def on_key(self, event: Any) -> None:
        """Close with a key that means something to what is behind."""
        if event.character in self._keys:
            event.stop()
            self.dismiss(event.character)

    def action_leave(self) -> None:
        """Back to the page."""
        self.dismiss(None)
