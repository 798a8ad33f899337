"""Shared by the course's full-screen programs: start, leave, show a message."""

import asyncio
import contextlib
import os
import signal
import threading
from collections.abc import Callable, Sequence
from time import perf_counter
from typing import TYPE_CHECKING, Any, ClassVar, TypeVar

from rich.console import RenderableType
from rich.text import Text
from textual.app import App, ComposeResult
from textual.binding import Binding
from textual.containers import VerticalScroll
from textual.events import Key, Resize
from textual.screen import ModalScreen
from textual.widgets import Input, Static

if TYPE_CHECKING:
    from textual.widget import Widget as _Widget
else:
    _Widget = object  # Textual takes a widget's style from its first base that is one

#: How long a message stays in the last line, in s.
_MESSAGE = 4.0
#: Between two keys of a line of them.
_BETWEEN = "   "

Answer = TypeVar("Answer")


class FullScreenApp(App[None]):
    """A program on the whole screen, which leaves the terminal as it found it.

    Args:
        clock: real time, in s.

    Attributes:
        in_colour: whether colours may be sent.
        failure: what went wrong inside; ``play`` raises it once the terminal is clean.
    """

    ENABLE_COMMAND_PALETTE = False
    #: Actions that work while something is laid over the screen.
    ALWAYS: ClassVar[frozenset[str]] = frozenset({"quit"})

    def __init__(self, clock: Callable[[], float] = perf_counter) -> None:
        # Without colour the terminal's own colours stay, rather than shades of grey.
        self.in_colour = not os.environ.get("NO_COLOR")
        super().__init__(ansi_color=None if self.in_colour else True)
        self.failure: BaseException | None = None
        self._clock = clock
        self._message = ("", 0.0)

    def play(self) -> None:
        """Run until its user leaves, and raise what went wrong inside."""
        # Textual answers Ctrl-Z and fg itself, and would go on when the screen is no longer its own.
        numbers = [getattr(signal, name) for name in ("SIGTSTP", "SIGCONT") if hasattr(signal, name)]
        before = {number: signal.getsignal(number) for number in numbers}
        try:
            with contextlib.suppress(KeyboardInterrupt):
                self.run()
        finally:
            for number, handler in before.items():
                with contextlib.suppress(ValueError):  # in another thread
                    signal.signal(number, handler)
            # Where the terminal goes away while this ends, Textual's thread that reads it goes on for ever.
            reading: threading.Event | None = getattr(self._driver, "exit_event", None)
            if reading is not None:
                reading.set()
        if self.failure is not None:
            raise self.failure

    def on_mount(self) -> None:
        loop = asyncio.get_running_loop()
        for name in ("SIGINT", "SIGTERM", "SIGHUP"):
            # A closed window or a plain kill leaves the terminal as clean as a key does. Where signals cannot
            # be caught here (Windows, another thread) the keys remain.
            with contextlib.suppress(NotImplementedError, AttributeError, RuntimeError, ValueError):
                loop.add_signal_handler(getattr(signal, name), self.action_quit_now)

    def _handle_exception(self, error: Exception) -> None:
        # The caller of ``play`` reports errors; a picture of the stack would be a second report.
        if self.failure is None:
            self.failure = error
        if self.is_headless:
            super()._handle_exception(error)
        else:
            self._return_code = 1
            self._close_messages_no_wait()

    def say(self, message: str) -> None:
        """Show something in the last line for a moment."""
        self._message = (message, self._clock())

    def hush(self) -> None:
        """A user who goes on has read the last line; it says the keys again."""
        self._message = ("", 0.0)

    @property
    def message(self) -> str:
        """The message in the last line; empty once it has been there long enough."""
        words, since = self._message
        return words if self._clock() - since < _MESSAGE else ""

    def check_action(self, action: str, parameters: tuple[object, ...]) -> bool | None:
        """Keys do nothing to what something is laid over, nor to a screen that is about to go."""
        del parameters
        if self._exit:
            return False
        return action in self.ALWAYS or len(self.screen_stack) == 1 or not hasattr(self, f"action_{action}")

    async def action_quit(self) -> None:
        self.action_quit_now()

    def action_quit_now(self) -> None:
        self.exit()


class Overlay(ModalScreen[Answer | None]):
    """A box over the screen, with a title above and its keys below. Dismissed with an answer, or None."""

    DEFAULT_CSS = """
    Overlay { align: center middle; background: black 40%; }
    Overlay > .box {
        width: 100%; max-width: 84; height: auto; max-height: 96%;
        border: round $primary; padding: 0 1; background: $surface; scrollbar-size-vertical: 1;
    }
    Overlay OptionList { height: auto; max-height: 80vh; border: none; background: $surface; padding: 0; }
    Overlay OptionList:focus { border: none; }
    Overlay Input { width: 100%; }
    """
    BINDINGS: ClassVar[list[Any]] = [Binding("escape", "leave", show=False)]
    #: Below the box: its keys, or a message.
    below = "Escape: back"

    def on_resize(self, event: Resize) -> None:
        del event
        self.fit_below()

    def fit_below(self) -> None:
        """Say below the box what there is room for."""
        self.query_one(".box").border_subtitle = fitting(self.below, min(self.size.width, 84) - 6)

    def close(self, answer: Answer | None) -> None:
        """Dismiss it, once: a second key that closes it may be on its way already."""
        if self.is_current:
            self.dismiss(answer)

    def action_leave(self) -> None:
        self.close(None)


class InOrder(_Widget):
    """Of a field to type in: its keys act in the order in which they were typed.

    Textual's fields insert a letter as it arrives, but Backspace and the like first pass every parent, so in
    a burst of keys the letters overtake them.
    """

    async def _on_key(self, event: Key) -> None:
        bound = [] if event.is_printable else self._bindings.key_to_bindings.get(event.key, [])
        for binding in bound:
            event.stop()
            event.prevent_default()
            if await self.app.run_action(binding.action, self):
                return


class Field(InOrder, Input):
    """A line to type in."""


class TextOverlay(Overlay[str]):
    """Something to read. Dismissed with the key that closed it, if it was one of ``keys``.

    Args:
        title: above it.
        shown: paragraphs, from top to bottom.
        keys: that mean something to what is below.
        hint: the keys, in words.
        at_end: begin with the end.
    """

    BINDINGS: ClassVar[list[Any]] = [Binding("enter,q,question_mark,f1", "leave", show=False)]

    def __init__(
        self,
        title: str,
        shown: Sequence[RenderableType],
        keys: Sequence[str] = (),
        hint: str = "Escape: back",
        *,
        at_end: bool = False,
    ) -> None:
        super().__init__()
        self._title, self._keys, self.below, self._at_end = title, tuple(keys), hint, at_end
        self._shown = [Text(one) if isinstance(one, str) else one for one in shown]

    def compose(self) -> ComposeResult:
        """The page, scrolled with arrows and the wheel."""
        with VerticalScroll(classes="box") as box:
            box.border_title = self._title
            for piece in self._shown:
                yield Static(piece)

    def on_mount(self) -> None:
        """Arrows scroll at once."""
        box = self.query_one(VerticalScroll)
        box.focus()
        if self._at_end:
            box.scroll_end(animate=False)

    def on_key(self, event: Any) -> None:
        """Close with a key that means something to what is below."""
        if event.character in self._keys:
            event.stop()
            self.close(event.character)


def fitting(keys: str, width: int, *, more: str = "") -> str:
    """The keys that fit: of a line that is too long, the first ones.

    Args:
        keys: each with what it does, three blanks between them.
        more: the key that shows all; it stays at the end.
    """
    parts = keys.split(_BETWEEN)
    if len(keys) <= width or len(parts) == 1:
        return shortened(keys, width)
    last = (more,) if more else ()
    kept = [part for part in parts if part != more]
    while len(kept) > 1 and len(_BETWEEN.join((*kept, *last))) > width:
        kept.pop()
    whole = _BETWEEN.join((*kept, *last))
    return whole if len(whole) <= width else shortened(kept[0], width)


def shortened(text: str, width: int) -> str:
    """As much of a text as fits, with a sign where it was cut."""
    return text if len(text) <= width else text[: max(1, width - 1)].rstrip() + "…"
