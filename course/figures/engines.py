"""Figures of the lesson on physics engines, drawn from what was measured of eight of them."""

from __future__ import annotations

import tomllib
from importlib.resources import files
from typing import TYPE_CHECKING, Any

from course.figures.style import PALETTE, new_figure, title

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["TESTS", "measured", "settings"]

_DEFAULT: dict[str, Any] = {
    "marker": "o",
    "markersize": 7.5,
    "markerfacecolor": "white",
    "color": PALETTE["vermillion"],
    "markeredgewidth": 1.4,
}
_TUNED: dict[str, Any] = {"marker": "D", "markersize": 4, "color": PALETTE["blue"]}

#: Column of the data -> what a panel is called.
TESTS = {
    "fall": "free fall",
    "rebound": "rebound",
    "slope": "slope",
    "pendulum": "pendulum",
    "clash": "clash",
}


def measured() -> dict[str, Any]:
    """What was measured, as ``course/lessons/data/engines.toml`` holds it."""
    path = files("course").joinpath("lessons", "data", "engines.toml")
    return tomllib.loads(path.read_text(encoding="utf-8"))


def settings() -> Figure:
    """Every engine's error in five tests, as it comes and with its options set."""
    table = measured()
    engines = table["engine"][::-1]
    figure, panels = new_figure(4.5, 1, len(TESTS), sharey=True)
    figure.subplots_adjust(left=0.16, wspace=0.14)
    for axes, (test, name) in zip(panels, TESTS.items(), strict=True):
        for row, engine in enumerate(engines):
            default = _error(engine["default"], test, table)
            tuned = _error(engine.get("tuned", engine["default"]), test, table)
            axes.plot([default, tuned], [row, row], color=PALETTE["grey"], linewidth=1.2)
            axes.plot(default, row, **_DEFAULT)
            axes.plot(tuned, row, **_TUNED)
        _frame(axes, name)
    panels[0].set_yticks(range(len(engines)), [engine["name"] for engine in engines])
    panels[2].set_xlabel("error (%)")
    _key(panels[0])
    title(figure, "Options moved one engine further than all well-set engines lie apart")
    return figure


def _error(row: dict[str, float], test: str, table: dict[str, Any]) -> float:
    """The error of one engine in one test, in per cent of the right value."""
    true = table["rebound_true_m"]
    share = row[test] / true - 1.0 if test == "rebound" else row[test]
    return 100.0 * share


def _frame(axes: Axes, name: str) -> None:
    axes.axvline(0.0, color=PALETTE["black"], linewidth=0.8)
    axes.set(xlim=(-118, 60), xticks=(-100, -50, 0, 50), ylim=(-1.9, 7.6))
    axes.set_xticklabels(["-100", "", "0", ""])
    axes.set_title(name)


def _key(axes: Axes) -> None:
    for y, look, words, ink in (
        (-0.95, _DEFAULT, "as it comes", "#B34F00"),
        (-1.55, _TUNED, "well set", "#0072B2"),
    ):
        axes.plot(-106, y, **look)
        axes.text(-92, y, words, color=ink, fontsize=8.5, va="center")
