"""The figure in the lesson on engines that shows what options do, drawn from the reference measurements."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from course.engines import reference
from course.engines.registry import ENGINES
from course.engines.results import DEFAULT, TUNED
from course.engines.scenarios.scenario import SCENARIOS
from course.figures.drawing.style import PALETTE, new_figure, title

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from course.engines.results import Row, Setting

__all__ = ["FLOOR", "LARGE", "TESTS", "Error", "error", "mended", "settings"]

_DEFAULT: dict[str, Any] = {
    "marker": "o",
    "markersize": 7.5,
    "markerfacecolor": "white",
    "color": PALETTE["vermillion"],
    "markeredgewidth": 1.4,
}
_TUNED: dict[str, Any] = {"marker": "D", "markersize": 4, "color": PALETTE["blue"]}

#: Scenario -> title of its panel.
TESTS = {
    "free-fall": "fall",
    "bounce": "rebound",
    "slide": "slope",
    "double-pendulum": "pendulum",
    "clash": "clash",
}
#: Errors below this are drawn at it, per cent.
FLOOR = 1e-3
#: An error of this many per cent is clearly visible.
LARGE = 10.0


@dataclass(frozen=True, slots=True)
class Error:
    """How far an engine is off, in per cent of the right value: the mean, and the worst phase or start."""

    mean: float
    worst: float


def error(engine: str, test: str, setting: Setting) -> Error:
    """One error, from the reference; nothing below ``FLOOR``."""
    row: Row = reference.row(engine, test, setting)
    scenario = SCENARIOS[test]
    truth = scenario.truth or 0.0
    # Where the truth is a height, errors are shares of it; elsewhere they come in per cent.
    unit = 1.0 if scenario.unit == "%" else 100.0 / truth

    def off(value: float) -> float:
        return max(unit * abs(value - truth), FLOOR)

    return Error(off(row.value or 0.0), max(off(row.lowest), off(row.highest)))


def mended() -> tuple[int, int]:
    """How many large errors disappear once options are set, and how many there are by default."""
    large = [(e, t) for e in ENGINES for t in TESTS if error(e, t, DEFAULT).mean > LARGE]
    return sum(error(e, t, TUNED).mean <= LARGE for e, t in large), len(large)


def settings() -> Figure:
    """Every engine's error in five tests, by default and well set, on logarithmic axes."""
    engines = list(ENGINES)[::-1]
    figure, panels = new_figure(4.5, 1, len(TESTS), sharey=True)
    figure.subplots_adjust(left=0.16, wspace=0.12)
    for axes, (test, name) in zip(panels, TESTS.items(), strict=True):
        for row, engine in enumerate(engines):
            default, tuned = (error(engine, test, setting) for setting in (DEFAULT, TUNED))
            axes.plot([default.mean, tuned.mean], [row, row], color=PALETTE["grey"], linewidth=1.2)
            if tuned.worst > tuned.mean:
                axes.plot([tuned.mean, tuned.worst], [row - 0.28] * 2, color=PALETTE["blue"], linewidth=1.0)
                axes.plot(tuned.worst, row - 0.28, marker="|", markersize=6, color=PALETTE["blue"])
            axes.plot(default.mean, row, **_DEFAULT)
            axes.plot(tuned.mean, row, **_TUNED)
        _frame(axes, name)
    panels[0].set_yticks(range(len(engines)), [ENGINES[engine].name for engine in engines])
    panels[2].set_xlabel("error (%), logarithmic; at the left edge 0.001 % or less")
    _key(panels[0], panels[2], panels[4])
    few, many = mended()
    title(figure, f"Of {many} errors above {LARGE:.0f} %, {few} are gone once the options are set")
    return figure


def _frame(axes: Axes, name: str) -> None:
    axes.set_xscale("log")
    axes.set(xlim=(0.4 * FLOOR, 600.0), xticks=(1e-3, 1e-1, 1e1), ylim=(-1.6, 7.6))
    axes.set_xticklabels(["0.001", "0.1", "10"])
    axes.minorticks_off()
    axes.plot([LARGE, LARGE], [-0.6, 7.6], color=PALETTE["grey"], linewidth=0.8, linestyle=":")
    axes.set_title(name)


def _key(left: Axes, middle: Axes, right: Axes) -> None:
    for axes, look, words, ink in (
        (left, _DEFAULT, "as it comes", "#B34F00"),
        (middle, _TUNED, "well set", "#0072B2"),
    ):
        axes.plot(2.0 * FLOOR, -1.15, **look)
        axes.text(6.0 * FLOOR, -1.15, words, color=ink, fontsize=8.5, va="center")
    right.plot([1.2 * FLOOR, 8.0 * FLOOR], [-1.15] * 2, color=PALETTE["blue"], linewidth=1.0)
    right.plot(8.0 * FLOOR, -1.15, marker="|", markersize=6, color=PALETTE["blue"])
    right.text(14.0 * FLOOR, -1.15, "worst phase", color="#0072B2", fontsize=8.5, va="center")
