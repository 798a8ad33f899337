"""Draws figures that are described as data, in the house style."""

import math
from typing import Any, assert_never

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.transforms import Bbox

from course.figures.described import Panel, Plot, Series
from course.figures.style import PALETTE, file_of, new_figure, title

_PANEL_IN = 2.3
#: Colour, line and marker go together, so that no two curves differ by colour alone.
_LOOKS: tuple[tuple[str, Any, str], ...] = (
    (PALETTE["blue"], "-", "o"),
    (PALETTE["vermillion"], "--", "s"),
    (PALETTE["green"], "-.", "^"),
    (PALETTE["purple"], ":", "D"),
    (PALETTE["orange"], (0, (5, 1, 1, 1, 1, 1)), "v"),
    (PALETTE["sky"], (0, (1, 1)), "P"),
    (PALETTE["black"], (0, (3, 1)), "X"),
)


def render(plot: Plot, kind: str = "png") -> bytes:
    """The figure as the bytes of a file; the same description gives the same bytes."""
    return file_of(lambda: draw(plot), kind)


def draw(plot: Plot) -> Figure:
    """The figure; call it inside ``house_style``."""
    columns = min(plot.columns, len(plot.panels))
    rows = math.ceil(len(plot.panels) / columns)
    # Each panel has its own labels here; in the lessons' figures panels share axes.
    figure, axes = new_figure(
        plot.height_in or 0.9 + _PANEL_IN * rows, rows, columns, hspace=0.55, wspace=0.28
    )
    for ax, panel in zip(axes, plot.panels, strict=False):
        _draw_panel(ax, panel)
    for ax in axes[len(plot.panels) :]:
        ax.set_visible(False)
    title(figure, plot.title)
    for ax, panel in zip(axes, plot.panels, strict=False):
        _legend(ax, panel)
    return figure


def _draw_panel(ax: Axes, panel: Panel) -> None:
    if "x" in panel.log:
        ax.set_xscale("log")
    if "y" in panel.log:
        ax.set_yscale("log")
    looks = iter(_LOOKS * (1 + len(panel.series) // len(_LOOKS)))
    for series in panel.series:
        _draw_series(ax, series, *((PALETTE["grey"], "-", ".") if series.quiet else next(looks)))
    ax.set_xlabel(panel.x_label)
    ax.set_ylabel(panel.y_label)
    if panel.title:
        ax.set_title(panel.title)
    if panel.equal:
        ax.set_aspect("equal", adjustable="datalim")


def _legend(ax: Axes, panel: Panel) -> None:
    """A legend on an empty spot. Where there is none, the vertical axis is extended at the top."""
    named = sum(bool(series.name) for series in panel.series)
    if not (named > 1 or (named and len(panel.series) > 1)):
        return
    ax.autoscale_view()  # matplotlib would do it only when it draws; the places are needed before
    legend = ax.legend(loc="best")
    if panel.equal:  # its limits follow from the scale
        return
    box = legend.get_window_extent().frozen()
    if not any(_crosses(line, box) for line in ax.lines):
        return
    # Side by side, the entries take half the height.
    columns = 2 if named > 2 and ax.get_window_extent().width > 2.5 * box.width else 1
    legend = ax.legend(loc="best", ncols=columns)
    taken = legend.get_window_extent().height / ax.get_window_extent().height + 0.06
    wanted = ax.transAxes.transform((0.0, 1.0 / (1.0 - min(taken, 0.6))))
    ax.set_ylim(top=ax.transData.inverted().transform(wanted)[1])


def _crosses(line: Line2D, box: Bbox) -> bool:
    """Whether a curve or one of its points lies in a box, in pixels."""
    path = line.get_transform().transform_path(line.get_path())
    if line.get_linestyle() in ("None", "none"):
        return bool(box.count_contains(path.vertices))
    return bool(path.intersects_bbox(box, filled=False))


def _draw_series(ax: Axes, series: Series, color: str, line: Any, marker: str) -> None:
    label = series.name or None
    x, y = np.asarray(series.x), np.asarray(series.y, dtype=float)
    low = y if series.low is None else np.asarray(series.low, dtype=float)
    high = y if series.high is None else np.asarray(series.high, dtype=float)
    match series.kind:
        case "line":
            width = 0.9 if series.quiet else 1.6
            ax.plot(x, y, color=color, linestyle=line, linewidth=width, label=label)
        case "steps":
            ax.step(x, y, where="post", color=color, linestyle=line, label=label)
        case "points":
            ax.plot(x, y, color=color, linestyle="none", marker=marker, label=label)
        case "band":
            ax.fill_between(x, y, high, color=color, alpha=0.2, linewidth=0, label=label)
        case "interval":
            # The reader should see a value outside its own interval; matplotlib would refuse it.
            # One broken line, because a legend keeps clear of lines but not of what vlines would draw.
            ends = np.column_stack([low, high, np.full(len(x), np.nan)]).ravel()
            ax.plot(np.repeat(x, 3), ends, color=color, linewidth=2.2, alpha=0.7)
            ax.plot(x, y, color=color, linestyle="none", marker=marker, label=label)
        case "bars":
            width = 0.8 * float(np.min(np.diff(x))) if x.dtype.kind in "fiu" and len(x) > 1 else 0.8
            ax.bar(x, y, width=width, color=color, alpha=0.85, label=label)
        case "level":
            ax.axhline(float(np.ravel(y)[0]), color=color, linestyle="--", linewidth=1, label=label)
        case _:
            assert_never(series.kind)
