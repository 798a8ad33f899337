"""Boxes over the picture: the question before a run, the numbers after it, the keys, the events."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, ClassVar

from rich.table import Table
from rich.text import Text
from textual.app import ComposeResult
from textual.binding import Binding
from textual.containers import VerticalScroll
from textual.widgets import Input, Static

from course.full_screen import Field, Overlay, TextOverlay
from course.printable import command
from course.sandbox.scene.loading import NO_GUESS, guess_of
from course.sandbox.scene.model import Scene
from course.sandbox.views.terminal.words import KEYS, clean

#: A heading and paragraphs, or lines of two columns.
Page = Sequence[str | tuple[str, str]]


class QuestionOverlay(Overlay[float]):
    """The scene's question and no more: what is said of the scene stands in its help.

    Dismissed with the guess, or None to run without one.
    """

    DEFAULT_CSS = "Ask #wrong { height: auto; }"

    def __init__(self, question: str, unit: str, *, calm: bool) -> None:
        super().__init__()
        self._question, self._unit, self._calm = question, unit, calm

    def compose(self) -> ComposeResult:
        """The question and a field for the answer."""
        with VerticalScroll(classes="box", can_focus=False) as box:
            box.border_title = "Before it runs: your guess"
            box.border_subtitle = "Enter: run   Escape: run without a guess"
            yield Static(Text(clean(self._question), style="bold"))
            entry = Field(placeholder=f"a number in {clean(self._unit)}", id="guess")
            entry.cursor_blink = not self._calm
            yield entry
            yield Static("", id="wrong", markup=False)

    def on_mount(self) -> None:
        """Focus the field, and keep the question in sight in a low window."""
        self.query_one(Input).focus()

    def on_input_submitted(self, event: Input.Submitted) -> None:
        """Take a number; an empty line means no guess."""
        if not event.value.strip():
            self.close(None)
            return
        guess = guess_of(event.value, self._unit)
        if guess is None:
            self.query_one("#wrong", Static).update(NO_GUESS)
            return
        self.close(guess)


class PageOverlay(TextOverlay):
    """A page to read."""

    BINDINGS: ClassVar[list[Any]] = [Binding("l", "leave", show=False)]

    def __init__(
        self,
        title: str,
        page: Page,
        keys: Sequence[str] = (),
        hint: str = "Escape: back",
        *,
        at_end: bool = False,
    ) -> None:
        super().__init__(title, [_shaped(piece) for piece in page], keys, hint, at_end=at_end)
        #: Everything on the page.
        self.words = "\n".join(piece if isinstance(piece, str) else " ".join(piece) for piece in page)


def _shaped(piece: str | tuple[str, str]) -> Text | Table:
    """A paragraph, a heading, or a name with a text beside it that wraps under itself."""
    if isinstance(piece, str):
        return Text(piece)
    name, text = piece
    if not text:
        return Text(name, style="bold")
    line = Table.grid(padding=(0, 1))
    line.add_column(width=12, style="bold")
    line.add_column(ratio=1)
    line.add_row(Text(name), Text(text))
    return line


def comparison(result: dict[str, Any], after: str) -> Page:
    """Theory, guess and simulation side by side, why, and what to think about next.

    Args:
        result: a ``Comparison`` as plain values; None where it has no number.
    """
    unit = "" if result["unit"] == "1" else f" {clean(result['unit'])}"
    rows = [("theory", result["theory"]), ("simulation", result["simulation"])]
    if result["guess"] is not None:
        rows.insert(0, ("your guess", result["guess"]))
    numbers = [(name, "did not happen" if value is None else f"{value:.6g}{unit}") for name, value in rows]
    return [
        (clean(result["question"]), ""),
        "",
        *numbers,
        "",
        (clean(result["verdict"]), ""),
        clean(result["why"]),
        "",
        f"And now: {clean(after)}",
    ]


def _own_settings(scene: Scene) -> Page:
    """How to start a scene with its own parameters, which have no keys."""
    if not scene.parameter:
        return ()
    first, *more = (one.name for one in scene.parameter)
    others = f"; also {', '.join(more)}" if more else ""
    start = command("sandbox", "play", scene.id, "--set", f"{first}=NUMBER").strip("`")
    return (("--set", f"for what has no key, when you start it: {start}{others}"),)


def help_pages(scene: Scene, *, wheels: bool) -> Page:
    """All keys, what the mouse does, and what the scene is about."""
    keys = {key: value for key, value in KEYS.items() if wheels or key not in {"left", "right"}}
    offered = [(f"{less} {more}", f"{name}: less, more") for less, more, name in keys.values()]
    return [
        ("Time", ""),
        ("space", "run, pause"),
        (".", "one step, and pause"),
        ("- +", "half as fast, twice as fast"),
        ("r", "reset: from the start, settings kept"),
        "",
        ("Hands", ""),
        ("mouse", "press near a body and drag it; letting go while it moves throws it"),
        ("", "while paused a drag aims: letting go throws the way it points"),
        ("right button", "a new ball where the pointer is"),
        ("arrows", "a pointer for the keyboard; with Shift five cells at a time"),
        ("Enter", "grab the body near the pointer, or let it go"),
        ("c b", "a new ball, a new box at the pointer"),
        "",
        ("Settings", ""),
        *offered,
        *_own_settings(scene),
        "",
        ("Looking", ""),
        ("n", "names on every body, however small"),
        ("l", "the list of events"),
        ("p", "the question and its answer again"),
        ("Tab", "hide or show the panel beside the picture"),
        ("m", "calm: four pictures a second, no flashes (always so with TEXTUAL_ANIMATIONS=none)"),
        ("q", "leave; Ctrl+C does the same"),
        "",
        ("About this scene", ""),
        clean(scene.teaches),
        clean(scene.note),
    ]
