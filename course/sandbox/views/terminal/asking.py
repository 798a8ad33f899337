"""Boxes over the picture: the question before a run, the numbers after it, the keys, the events."""

from collections.abc import Callable, Sequence
from typing import Any, ClassVar

import numpy as np
from rich.table import Table
from rich.text import Text
from textual.app import ComposeResult
from textual.binding import Binding
from textual.containers import Container, Horizontal, Vertical, VerticalScroll
from textual.events import Resize
from textual.widgets import Input, OptionList, Static
from textual.widgets.option_list import Option

from course.errors import CourseError
from course.full_screen import Field, Overlay, TextOverlay
from course.sandbox.runs.tape import preview
from course.sandbox.scene.loading import unchanged
from course.sandbox.scene.model import Scene
from course.sandbox.views.terminal.picture import Camera, Picture
from course.sandbox.views.terminal.picture import Overlay as Drawn
from course.sandbox.views.terminal.words import KEYS, Canvas, clean
from course.sandbox.world.world import Snapshot

#: Below this many columns there is no room beside a picture or a list.
NARROW = 60
#: A heading and paragraphs, or lines of two columns.
Page = Sequence[str | tuple[str, str]]


class LineOverlay(Overlay[Any]):
    """A page, and below it a line to type, which stays while it cannot be taken.

    Dismissed with what was made of the line, or None if it was empty.

    Args:
        take: makes the answer of a line; raises a CourseError if that cannot be done.
        wanted: what to type, in the empty line.
    """

    def __init__(
        self,
        title: str,
        page: Page,
        take: Callable[[str], Any],
        *,
        wanted: str,
        below: str,
        calm: bool = False,
    ) -> None:
        super().__init__()
        self._title, self._page, self._take = title, page, take
        self._wanted, self.below, self._calm = wanted, below, calm

    def compose(self) -> ComposeResult:
        with VerticalScroll(classes="box", can_focus=False) as box:
            box.border_title = self._title
            for piece in self._page:
                yield Static(_shaped(piece))
            entry = Field(placeholder=self._wanted)
            entry.cursor_blink = not self._calm
            yield entry
            yield Static("", id="wrong", markup=False)

    def on_mount(self) -> None:
        """Focus the line, and keep the page in sight in a low window."""
        self.query_one(Input).focus()

    def on_input_submitted(self, event: Input.Submitted) -> None:
        """Take the line and close, or say why not."""
        line = event.value.strip()
        try:
            self.close(self._take(line) if line else None)
        except CourseError as error:
            self.query_one("#wrong", Static).update(clean(error.message))


class Gallery(Overlay[str]):
    """Every scene, and how the one under the cursor moves. Dismissed with its id.

    Args:
        current: id of the one that is played now.
    """

    DEFAULT_CSS = """
    Gallery > .box { max-width: 100%; height: 100%; max-height: 100%; }
    Gallery Horizontal { height: 100%; }
    Gallery OptionList { width: 34; max-height: 100%; height: 100%; }
    Gallery .beside { width: 1fr; padding: 0 0 0 1; }
    Gallery Static { height: auto; max-height: 8; }
    Gallery.narrow Horizontal { layout: vertical; }
    Gallery.narrow OptionList { width: 100%; height: auto; max-height: 70%; }
    Gallery.narrow .beside { width: 100%; height: 1fr; }
    """
    BINDINGS: ClassVar[list[Any]] = [Binding("q", "app.quit", show=False)]
    below = "Enter: play   Escape: back   q: leave"

    def __init__(
        self, found: Sequence[Scene], played: set[str], current: str, *, colour: bool, calm: bool
    ) -> None:
        super().__init__()
        self._found, self._played, self._current = found, played, current
        self._colour, self._calm = colour, calm
        self._loops: dict[str, tuple[Any, ...]] = {}
        self._number = 0
        self._picture: tuple[str, Camera, Picture] | None = None

    def compose(self) -> ComposeResult:
        with Container(classes="box") as box:
            box.border_title = "Scenes"
            with Horizontal():
                options = (
                    Option(f"{'✓' if one.id in self._played else ' '} {clean(one.title)}", id=one.id)
                    for one in self._found
                )
                yield OptionList(*options)
                with Vertical(classes="beside"):
                    yield Static("", id="about", markup=False)
                    yield Canvas(colour=self._colour, id="loop")

    def on_mount(self) -> None:
        """Begin with the scene that is played now."""
        chooser = self.query_one(OptionList)
        chooser.highlighted = next((i for i, one in enumerate(self._found) if one.id == self._current), 0)
        chooser.focus()
        self.set_interval(1 / 4 if self._calm else 1 / 20, self.move)

    def on_resize(self, event: Resize) -> None:
        """Where there is no room beside the list, what it is about goes below."""
        self.set_class(event.size.width < NARROW, "narrow")

    def move(self) -> None:
        """The next picture of the scene under the cursor."""
        chooser, canvas = self.query_one(OptionList), self.query_one(Canvas)
        scene = self._found[chooser.highlighted or 0]
        done = "Played before. " if scene.id in self._played else ""
        self.query_one("#about", Static).update(f"{done}{clean(scene.teaches)}")
        width, height = canvas.size
        if not width or not height:
            return
        if scene.id not in self._loops:
            self._loops[scene.id] = preview(unchanged(scene))
            self._number = 0
        parts, places, joints = self._loops[scene.id]
        camera = Camera.fit(scene.view, width, height)
        if self._picture is None or self._picture[:2] != (scene.id, camera):
            self._picture = scene.id, camera, Picture(parts, camera, self._colour)
        at = 0 if self._calm else self._number % len(places)
        self._number += 1
        x, y, angle = np.nan_to_num(places[at].astype(float), nan=1e6).T
        none = np.zeros(len(parts))
        shot = Snapshot(0.0, 0, x, y, angle, none, none, joints[at].astype(float), None)
        canvas.show(self._picture[2].draw(shot, Drawn()))

    def on_option_list_option_selected(self, event: OptionList.OptionSelected) -> None:
        self.close(event.option.id)


class PageOverlay(TextOverlay):
    BINDINGS: ClassVar[list[Any]] = [Binding("l", "leave", show=False)]

    def __init__(self, title: str, page: Page, **more: Any) -> None:
        super().__init__(title, [_shaped(piece) for piece in page], **more)
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


def help_pages(scene: Scene, *, wheels: bool) -> Page:
    """All keys, what the mouse does, and what the scene is about."""
    keys = {key: value for key, value in KEYS.items() if wheels or key not in {"left", "right"}}
    offered = [(f"{less} {more}", f"{name}: less, more") for less, more, name in keys.values()]
    return [
        ("Time", ""),
        ("space", "run, pause"),
        (", .", "a picture back, a picture on; in the past, too"),
        ("< >", "half a second back, on"),
        (":", "one step of the solver"),
        ("x", "to the next contact"),
        ("j", "play backwards"),
        ("Enter", "in the past: go on from here"),
        ("k", "back to now"),
        ("- +", "half as fast, twice as fast"),
        ("r", "reset: from the start, settings kept"),
        ("u U", "undo, redo: back to before the last thing that was done"),
        "",
        ("Hands", ""),
        ("mouse", "press near a body and drag it; letting go while it moves throws it"),
        ("", "while paused a drag places it; beside the bodies it moves the picture"),
        (
            "right button",
            "a new ball where the pointer is; on a body it aims: letting go throws the way it points",
        ),
        ("arrows", "a pointer for the keyboard; with Shift five cells at a time"),
        *((("", "here they drive the wheels; with Shift they move the pointer"),) if wheels else ()),
        ("Enter", "grab the body near the pointer, or let it go; while paused, carry it"),
        ("v", "aim the body near the pointer, and again to let go"),
        ("c b", "a new ball, a new box at the pointer"),
        ("y", "copy the body near the pointer"),
        ("Delete", "take it away; Backspace does the same"),
        ("s", "stop everything"),
        ("", f"placing by eye is better done in the page: course sandbox play {scene.id} --web"),
        "",
        ("Settings", ""),
        ("/", "the scene's own numbers, and those of the body near the pointer"),
        *offered,
        "",
        ("Looking", ""),
        ("o", "all scenes; Escape does the same"),
        ("PgUp PgDn", "closer, farther; Home shows all of it"),
        ("z", "follow the body near the pointer"),
        ("t", "trace the body near the pointer"),
        ("Z", "show the run before this one as dots"),
        ("n", "names on every body, however small"),
        ("l", "the list of events"),
        ("p", "predict: the question, and its answer"),
        ("Ctrl+S", "save this run as a film (GIF)"),
        ("Tab", "hide or show the panel beside the picture"),
        ("m", "calm: four pictures a second, no flashes (always so with TEXTUAL_ANIMATIONS=none)"),
        ("q", "leave; Ctrl+C does the same"),
        "",
        ("About this scene", ""),
        clean(scene.teaches),
        clean(scene.note),
    ]
