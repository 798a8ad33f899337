"""One look for every figure: colours that colour-blind readers can tell apart, and never colour alone.

The palette is Okabe and Ito's. Each method of integration has, beside its colour, a line style and a marker
of its own and, where there is room, its name at the curve, so that a photocopy still tells them apart.

Source: Okabe and Ito, Color Universal Design, 2002 (palette).
"""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from io import BytesIO
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from numpy.typing import NDArray

Array = NDArray[np.float64]

PALETTE = {
    "black": "#000000",
    "orange": "#E69F00",
    "sky": "#56B4E9",
    "green": "#009E73",
    "yellow": "#F0E442",
    "blue": "#0072B2",
    "vermillion": "#D55E00",
    "purple": "#CC79A7",
    "grey": "#6B6B6B",
}

#: The same hues, dark enough for letters on white (contrast 4.5 to 1 or more).
INK = {
    "black": "#000000",
    "orange": "#8F6200",
    "sky": "#1F6F9F",
    "green": "#007A58",
    "blue": "#0072B2",
    "vermillion": "#B34F00",
    "purple": "#9C4478",
    "grey": "#4A4A4A",
}

#: Of a figure of page width, 6.5 in, this makes 1170 pixels.
_FILE_DPI = 180
#: Nothing in a file but the picture: no dates, no random ids.
_METADATA: dict[str, dict[str, Any]] = {
    "png": {"Software": None},
    "svg": {"Date": None, "Creator": None},
    "pdf": {"CreationDate": None, "Producer": None, "Creator": None},
}

#: Text width of a printed page.
WIDTH_IN = 6.5
# Margins round the axes, inches: room for labels and, above, for the finding and the titles of panels.
_LEFT_IN, _RIGHT_IN, _BOTTOM_IN, _TOP_IN, _TITLE_IN = 0.72, 0.12, 0.5, 0.36, 0.2

_RC: dict[str, Any] = {
    "font.family": "DejaVu Sans",  # shipped with matplotlib, so every machine draws the same letters
    "font.size": 9.0,
    "axes.titlesize": 9.5,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "axes.labelsize": 9.0,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.linewidth": 0.8,
    "axes.edgecolor": "#333333",
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": "#E2E2E2",
    "grid.linewidth": 0.6,
    "xtick.labelsize": 8.5,
    "ytick.labelsize": 8.5,
    "legend.frameon": False,
    "legend.fontsize": 8.5,
    "lines.linewidth": 1.6,
    "lines.markersize": 4.5,
    "figure.facecolor": "white",
    "savefig.facecolor": "white",
    "text.parse_math": True,
    "mathtext.fontset": "dejavusans",
    "path.simplify": True,
    "agg.path.chunksize": 0,
}


@dataclass(frozen=True, slots=True)
class MethodLook:
    """How one method of integration is drawn everywhere.

    Attributes:
        color: of its curve, from PALETTE.
        ink: of its name, from INK.
    """

    name: str
    color: str
    ink: str
    line: str
    marker: str


METHODS = {
    "explicit_euler": MethodLook("explicit Euler", PALETTE["vermillion"], INK["vermillion"], ":", "v"),
    "semi_implicit_euler": MethodLook("semi-implicit Euler", PALETTE["blue"], INK["blue"], "--", "o"),
    "velocity_verlet": MethodLook("velocity Verlet", PALETTE["green"], INK["green"], "-", "s"),
    "rk4": MethodLook("Runge-Kutta 4", PALETTE["purple"], INK["purple"], "-.", "D"),
}


@contextmanager
def house_style() -> Iterator[None]:
    """The course's settings while a figure is drawn, and nothing from the reader's own matplotlibrc."""
    # The backend is left alone: figures here bring their own canvas, and setting it would import pyplot.
    settings: dict[Any, Any] = {
        key: value for key, value in mpl.rcParamsDefault.items() if not key.startswith("backend")
    }
    settings.update(_RC)
    with mpl.rc_context(settings):
        yield


def new_figure(
    height_in: float,
    rows: int = 1,
    columns: int = 1,
    *,
    sharex: bool = False,
    sharey: bool = False,
    **room: float,
) -> tuple[Figure, list[Axes]]:
    """A figure of page width with a grid of axes, row by row, and no window behind it.

    The axes sit where the margins say, whatever the letters measure, so that two versions of matplotlib put
    every curve in the same place.

    Args:
        sharex, sharey: as for matplotlib's ``subplots``.
        room: margins other than usual, as for its ``subplots_adjust``.
    """
    figure = Figure(figsize=(WIDTH_IN, height_in))
    FigureCanvasAgg(figure)
    usual = {
        "left": _LEFT_IN / WIDTH_IN,
        "right": 1.0 - _RIGHT_IN / WIDTH_IN,
        "bottom": _BOTTOM_IN / height_in,
        "top": 1.0 - (_TOP_IN + (_TITLE_IN if rows * columns > 1 else 0.0)) / height_in,
        "hspace": 0.14,
        "wspace": 0.08,
    }
    figure.subplots_adjust(**usual | room)
    axes = figure.subplots(rows, columns, squeeze=False, sharex=sharex, sharey=sharey)
    return figure, list(axes.flat)


def title(figure: Figure, finding: str) -> Figure:
    """Head a figure with what it shows, a sentence and not a topic, and give it back."""
    top = 1.0 - 0.08 / figure.get_figheight()
    figure.suptitle(finding, x=0.012, y=top, ha="left", va="top", fontsize=10.5, fontweight="bold")
    return figure


def word(axes: Axes, x: float, y: float, text: str, ink: str = "black", **more: Any) -> None:
    """A name beside what it names, in data coordinates; ``ink`` is one of INK."""
    axes.text(x, y, text, color=INK[ink], fontsize=8.5, fontweight="bold", **more)


def ring(axes: Axes, x: float, y: float, color: str = "black", **more: Any) -> None:
    """An empty circle round a point; ``color`` is one of PALETTE."""
    axes.plot(x, y, marker="o", markersize=9, markerfacecolor="none", color=PALETTE[color], **more)


def note(
    axes: Axes, text: str, at: tuple[float, float], place: tuple[float, float], color: str = INK["black"]
) -> None:
    """A remark with a thin line to its point, both in data coordinates."""
    axes.annotate(
        text,
        xy=at,
        xytext=place,
        color=color,
        fontsize=8.5,
        arrowprops={"arrowstyle": "-", "color": color, "linewidth": 0.8, "shrinkA": 1, "shrinkB": 2},
    )


def file_of(draw: Callable[[], Figure], kind: str) -> bytes:
    """A figure as the bytes of a file to keep; the same figure gives the same bytes.

    Args:
        draw: makes the figure, in the house style.
        kind: "png", "svg" or "pdf".
    """
    out = BytesIO()
    with house_style(), mpl.rc_context({"svg.hashsalt": "course"}):
        draw().savefig(out, format=kind, dpi=_FILE_DPI, metadata=_METADATA[kind])
    return out.getvalue()
