"""The panel beside the picture: numbers, small curves and lines of text, as plain pieces."""

import math
import re
import textwrap
from collections.abc import Sequence
from itertools import zip_longest

import numpy as np
from rich.color import Color
from rich.segment import Segment
from rich.style import Style
from textual.geometry import Region
from textual.strip import Strip
from textual.widget import Widget

from course.sandbox.runs.tape import SAMPLED, account_of
from course.sandbox.scene.rules import SETTINGS
from course.sandbox.views.stage import Stage
from course.sandbox.views.terminal.picture import Cells
from course.sandbox.world.accounts import Receipt
from course.sandbox.world.engine import Floats
from course.sandbox.world.world import World


def speed_in_words(speed: float) -> str:
    """How fast time passes: "real time", "2 x real time", "1/8 of real time"."""
    if abs(speed - 1.0) < 1e-9:
        return "real time"
    if speed > 1.0:
        return f"{speed:.3g} x real time"
    return f"1/{1 / speed:.0f} of real time"


#: A line is pieces of text, each with a style: "", "bold", "dim" or a colour as #rrggbb.
Line = tuple[tuple[str, str], ...]

_BARS = " ▁▂▃▄▅▆▇█"
_CONTROLS = re.compile(r"[\x00-\x1f\x7f-\x9f\u200e\u200f\u202a-\u202e\u2066-\u2069]+")

#: Key for less, key for more, and the short name of each setting.
KEYS = {
    "gravity": ("g", "G", "gravity"),
    "restitution": ("e", "E", "restitution"),
    "friction": ("f", "F", "friction"),
    "step": ("h", "H", "step h"),
    "iterations": ("i", "I", "iterations"),
    "walls": ("w", "W", "walls"),
    "left": ("a", "A", "left wheel"),
    "right": ("d", "D", "right wheel"),
}
_ENERGIES = (
    ("kinetic", "motion", "#66ccee"),
    ("potential", "height", "#ccbb44"),
    ("contacts", "contacts", "#ee6677"),
    ("friction", "friction", "#dd88bb"),
    ("rods", "rods", "#ee99aa"),
    ("residual", "solver", "#b0b6bf"),
)
_MOMENTA = (("px", "along x", "#66ccee"), ("py", "along y", "#ccbb44"), ("angular", "turning", "#b0b6bf"))
_NAME, _NUMBER = 9, 8


def clean(text: str) -> str:
    """A text on one line, without control codes."""
    return " ".join(_CONTROLS.sub(" ", text).split())


def shown(value: float, scale: float = 0.0) -> str:
    """A number in at most seven characters; 0 if it is negligible beside ``scale``."""
    if not math.isfinite(value):
        return "none"
    if abs(value) <= 1e-9 * scale or value == 0.0:
        return "0"
    if 0.001 <= abs(value) < 99999.5:
        digits = max(0, 3 - max(0, math.floor(math.log10(abs(value)))))
        return f"{value:.{digits}f}"
    short = f"{value:.1e}" if 1e-9 < abs(value) < 9.94e9 else f"{value:.0e}"
    return short.replace("e-0", "e-").replace("e+0", "e").replace("e+", "e")


def bars(values: Floats, width: int, low: float, span: float, height: int = 1) -> list[str]:
    """A curve of vertical bars.

    Args:
        values: (n,), oldest first; brought to ``width`` columns by their means.
        low, span: the value at the bottom, and how much fits above it.
        height: in lines.

    Returns:
        its lines, the uppermost first.
    """
    if not len(values) or width < 1:
        return [" " * width] * height
    edges = np.linspace(0, len(values), min(width, len(values)) + 1).astype(int)
    means = np.add.reduceat(values, edges[:-1]) / np.diff(edges)
    means = np.interp(np.linspace(0, 1, width), np.linspace(0, 1, len(means)), means)
    full = np.nan_to_num((means - low) / span if span > 0 else means * 0.0)
    # The lowest bar is an eighth of a line, so that a curve is never blank.
    eighths = np.clip(np.rint(full * (8 * height - 1)) + 1, 1, 8 * height).astype(int)
    rows = range(height - 1, -1, -1)
    return ["".join(_BARS[k] for k in np.clip(eighths - 8 * row, 0, 8)) for row in rows]


def wrapped(text: str, width: int) -> list[str]:
    """A text in lines that fit; a word that does not is cut."""
    return textwrap.wrap(clean(text), width, break_on_hyphens=False) or [""]


def head(world: World, t: float, state: str, pace: float, width: int) -> Line:
    """The line above the picture."""
    # A short lag is not worth a word.
    slow = "" if world.paused or pace > 0.75 else f", but this machine manages {100 * pace:.0f} % of it"
    right = f"{t:.3f} s  {state or speed_in_words(world.speed)}{slow} "
    title = clean(world.scene.title)
    room = width - len(right) - 3
    if room < len(title):
        title = title[: max(0, room - 1)] + "…" if room > 4 else ""
    gap = max(1, width - len(title) - len(right) - 1)
    return ((f" {title}", "bold"), (" " * gap, ""), (right[: max(0, width - 2)], "bold" if state else ""))


def keys_line(width: int, *, paused: bool, past: bool, compared: bool = False) -> Line:
    """The line below everything: as many keys as there is room for."""
    offered = [
        ("space", "run" if paused else "pause"),
        *((("Enter", "go on"), ("k", "now")) if past else (("o", "scenes"),)),
        ("?", "all keys"),
        *(() if past else (("p", "result" if compared else "predict"),)),
        (", .", "back, on"),
        ("r", "reset"),
        ("u", "undo"),
        ("q", "leave"),
        ("/", "numbers"),
        ("-+", "speed"),
        ("c b", "new ball, box"),
        ("gG", "gravity"),
        ("eE", "restitution"),
        ("fF", "friction"),
        ("hH", "step size"),
        ("n", "names"),
        ("l", "events"),
    ]
    pieces: list[tuple[str, str]] = []
    used = 0
    for key, what in offered:
        needed = len(key) + len(what) + 3
        if used + needed > width:
            break
        pieces += [(f" {key}", "bold"), (f" {what} ", "")]
        used += needed
    return tuple(pieces)


def panel(stage: Stage, parameters: Sequence[tuple[str, str]], width: int, height: int) -> list[Line]:
    """Energy and momentum at the time that is shown, and settings, for a column beside the picture.

    Args:
        parameters: the scene's own, with their values.
        width, height: of the column, in cells.
    """
    world = stage.world
    receipt, momentum = world.receipt, world.momentum
    if stage.at is not None:
        receipt, momentum = account_of(stage.frame(), receipt.start)
    history = dict(zip(SAMPLED, stage.tape.samples(until=stage.t).T, strict=True))
    settings = _settings(world, parameters, width)
    tall = max(1, min(4, (height - 5 - len(settings) - 3) // 8))
    lines = [*_energy(history, receipt, width, tall), *_momentum(history, momentum, width, tall)]
    # Where there is little room, blank lines go first, then a heading and angular momentum.
    if len(lines) + len(settings) + 2 <= height:
        split = 2 + len(_drawn(receipt)) * tall
        return [*lines[:split], ((" ", ""),), *lines[split:], ((" ", ""),), *settings]
    if len(lines) + len(settings) > height:
        lines, settings = lines[:-1], settings[1:]
    return [*lines, *settings][:height]


def _drawn(receipt: Receipt) -> list[tuple[str, str, str]]:
    """The curves of energy: most scenes have no rods, and most rods take nothing."""
    return [one for one in _ENERGIES if one[0] != "rods" or receipt.rods]


def _energy(history: dict[str, Floats], receipt: Receipt, width: int, tall: int) -> list[Line]:
    drawn = _drawn(receipt)
    series = {name: history[name] for name, _, _ in drawn}
    had = receipt.start + receipt.given
    scale = max(abs(had), *(abs(getattr(receipt, name)) for name in series), 1e-12)
    # Samples have seven digits: what is smaller than that is no change.
    span = max(max((float(np.ptp(v)) for v in series.values() if len(v)), default=0.0), 1e-6 * scale)
    lines: list[Line] = [(("Energy in J", "bold"),)]
    for name, label, colour in drawn:
        values = series[name]
        lines += _curve(label, values, getattr(receipt, name), scale, span, width, tall, colour)
    total = shown(had, scale)
    label = "= start + given" if abs(receipt.given) > 1e-9 * scale else "= start"
    lines.append(((f"{label:<{max(0, width - _NUMBER)}}", ""), (f"{total:>{_NUMBER}}", "bold")))
    return lines


def _momentum(
    history: dict[str, Floats], momentum: tuple[float, float, float], width: int, tall: int
) -> list[Line]:
    series = [history[name] for name, _, _ in _MOMENTA]
    scale = max(*(abs(value) for value in momentum), 1e-12)
    lines: list[Line] = [(("Momentum in kg m/s", "bold"),)]
    for (_, label, colour), values, value in zip(_MOMENTA, series, momentum, strict=True):
        # Angular momentum has a unit and a size of its own; the two others share theirs.
        peers = series[2:] if label == "turning" else series[:2]
        largest = max((float(np.abs(v).max()) for v in peers if len(v)), default=0.0)
        span = max(max((float(np.ptp(v)) for v in peers if len(v)), default=0.0), 1e-6 * largest, 1e-12)
        lines += _curve(label, values, value, scale, span, width, tall, colour)
    return lines


def _curve(
    label: str, values: Floats, value: float, scale: float, span: float, width: int, tall: int, colour: str
) -> list[Line]:
    """A name, a curve and a number; the curve may be several lines high."""
    room = width - _NAME - _NUMBER
    drawn = bars(values, max(0, room), float(np.min(values)) if len(values) else 0.0, span, tall)
    lines: list[Line] = [((" " * _NAME, ""), (text, colour)) for text in drawn[:-1]]
    number = f"{shown(value, scale):>{_NUMBER}}"
    return [*lines, ((f"{label:<{_NAME}}", ""), (drawn[-1], colour), (number, "bold"))]


def _settings(world: World, parameters: Sequence[tuple[str, str]], width: int) -> list[Line]:
    lines: list[Line] = [(("Settings, less and more", "bold"),)]
    for name, text in parameters:
        room = max(0, width - 4 - len(text))
        lines.append((("/  ", "bold"), (f" {name:<{room}}"[: room + 1], ""), (text, "bold")))
    for key, (less, more, name) in KEYS.items():
        if key not in world.settings and key in {"left", "right"}:
            continue
        value = world.settings.get(key, 0.0 if key == "walls" else None)
        text = "own" if value is None else setting(key, value)
        room = max(0, width - 4 - len(text))
        lines.append(((f"{less}{more} ", "bold"), (f" {name:<{room}}"[: room + 1], ""), (text, "bold")))
    return lines


def setting(key: str, value: float) -> str:
    """A setting with its unit, as short as it can be said."""
    if key == "walls":
        return "on" if value else "off"
    if key == "step":
        return f"{1000 * value:.3g} ms"
    unit = SETTINGS[key].unit
    return f"{value:.4g}" if unit == "1" else f"{value:.4g} {unit}"


# ---
# Two widgets that send only what changed: a canvas of cells and a few lines of text.


#: Pairs of colours kept; a scene has some hundreds.
_STYLES = 8192
_PLAIN = Style()


class Canvas(Widget):
    """Shows cells; sends the rows that differ from the last frame, from first to last difference."""

    DEFAULT_CSS = "Canvas { width: 1fr; height: 1fr; }"
    ALLOW_SELECT = False

    def __init__(self, *, colour: bool, id: str | None = None) -> None:  # noqa: A002
        super().__init__(id=id)
        #: Rows sent so far.
        self.sent = 0
        self._colour = colour
        #: The frame that is shown.
        self.cells: Cells | None = None
        self._styles: dict[int, Style] = {}

    def show(self, cells: Cells) -> None:
        changes = cells.changes(self.cells)
        self.cells = cells
        if changes:
            self.sent += len(changes)
            self.refresh(*(Region(first, row, count, 1) for row, first, count in changes))

    def render_line(self, y: int) -> Strip:
        cells, width = self.cells, self.size.width
        if cells is None or y >= cells.char.shape[0]:
            return Strip.blank(width)
        text = cells.char[y].astype("<u4").tobytes().decode("utf-32-le")
        if not self._colour:
            return Strip([Segment(text, _PLAIN)], len(text)).adjust_cell_length(width, _PLAIN)
        keys = cells.ink[y].astype(np.int64) << 24 | cells.paper[y]
        starts = [0, *(np.flatnonzero(np.diff(keys)) + 1).tolist(), len(text)]
        pairs = keys[starts[:-1]].tolist()
        strip = Strip(
            [
                Segment(text[a:b], self._style(key))
                for a, b, key in zip(starts[:-1], starts[1:], pairs, strict=True)
            ],
            len(text),
        )
        return strip if len(text) == width else strip.adjust_cell_length(width, _PLAIN)

    def _style(self, key: int) -> Style:
        style = self._styles.get(key)
        if style is None:
            if len(self._styles) >= _STYLES:
                self._styles.clear()
            style = self._styles[key] = Style(color=_colour(key >> 24), bgcolor=_colour(key & 0xFFFFFF))
        return style


class Lines(Widget):
    """Shows lines of text, and sends those that changed.

    Args:
        ink, paper: colours; None for the terminal's own.
    """

    ALLOW_SELECT = False

    def __init__(self, ink: str | None, paper: str | None, id: str | None = None) -> None:  # noqa: A002
        super().__init__(id=id)
        self._base = Style(color=ink, bgcolor=paper)
        self._in_colour = ink is not None
        self._lines: list[Line] = []
        self._named: dict[str, Style] = {}

    @property
    def text(self) -> str:
        """The lines, without styles."""
        return "\n".join("".join(piece for piece, _ in line) for line in self._lines)

    def show(self, lines: Sequence[Line]) -> None:
        pairs = enumerate(zip_longest(self._lines, lines))
        width, height = self.size
        changed = [row for row, (before, now) in pairs if row < height and before != now]
        self._lines = list(lines)
        if changed:
            self.refresh(*(Region(0, row, width, 1) for row in changed))

    def render_line(self, y: int) -> Strip:
        width = self.size.width
        if y >= len(self._lines):
            return Strip.blank(width, self._base)
        pieces = [Segment(text, self._style(style)) for text, style in self._lines[y] if text]
        return Strip(pieces).adjust_cell_length(width, self._base)

    def _style(self, name: str) -> Style:
        if name not in self._named:
            own = "" if name.startswith("#") and not self._in_colour else name
            self._named[name] = self._base + Style.parse(own)
        return self._named[name]


def _colour(value: int) -> Color:
    return Color.from_rgb(value >> 16, value >> 8 & 255, value & 255)
