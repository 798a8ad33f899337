"""The figure in the lesson on engines that shows what options do, drawn from the reference measurements."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patheffects import withStroke

from course.engines import reference
from course.engines.compare import LADDER
from course.engines.findings import grouped, slope
from course.engines.registry import ENGINES
from course.engines.results import DEFAULT, TUNED, Row, Setting
from course.engines.scenarios import BOXES, SCENARIOS
from course.figures.style import INK, PALETTE, file_of, new_figure, title

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
    figure, panels = new_figure(4.5, 1, len(TESTS), sharey=True, left=0.16, wspace=0.12)
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
    return title(figure, f"Of {many} errors above {LARGE:.0f} %, {few} are gone once the options are set")


def _frame(axes: Axes, name: str) -> None:
    axes.set_xscale("log")
    axes.set(xlim=(0.4 * FLOOR, 600.0), xticks=(1e-3, 1e-1, 1e1), ylim=(-1.6, 7.6))
    axes.set_xticklabels(["0.001", "0.1", "10"])
    axes.minorticks_off()
    axes.plot([LARGE, LARGE], [-0.6, 7.6], color=PALETTE["grey"], linewidth=0.8, linestyle=":")
    axes.set_title(name)


def _key(left: Axes, middle: Axes, right: Axes) -> None:
    for axes, look, words, ink in (
        (left, _DEFAULT, "as it comes", "vermillion"),
        (middle, _TUNED, "well set", "blue"),
    ):
        axes.plot(2.0 * FLOOR, -1.15, **look)
        axes.text(6.0 * FLOOR, -1.15, words, color=INK[ink], fontsize=8.5, va="center")
    right.plot([1.2 * FLOOR, 8.0 * FLOOR], [-1.15] * 2, color=PALETTE["blue"], linewidth=1.0)
    right.plot(8.0 * FLOOR, -1.15, marker="|", markersize=6, color=PALETTE["blue"])
    right.text(14.0 * FLOOR, -1.15, "worst phase", color=INK["blue"], fontsize=8.5, va="center")


# ---
# Figures of a comparison of engines: how errors shrink with the step, and what accuracy costs.
#
# ``render`` serves ``course engines compare --plot``; ``speed`` draws the reference, for a lesson.


#: How each engine is drawn everywhere: its colour and its marker.
_LOOKS = {
    "pymunk": ("grey", "P"),
    "mujoco": ("purple", "D"),
    "ode": ("orange", "v"),
    "bullet": ("vermillion", "s"),
    "rapier": ("green", "o"),
    "physx": ("blue", "^"),
    "pybullet": ("black", "x"),
    "dart": ("sky", "*"),
}
#: Below this an error is drawn at the foot of the figure, per cent.
_FLOOR = 1e-11
#: On axes of ten decades, errors that differ by less than this share look like one curve.
_ALIKE = 0.5
#: From one line of small letters to the next, inches.
_LINE_IN = 0.155
#: So many small letters fit between the second of five points and the right edge.
_LINE_LETTERS = 28


def speed() -> Figure:
    """How far a stack moves against the rate with a hundred boxes, from the reference."""
    return _speed(reference.load().rows)


def render(rows: Sequence[Row], kind: str) -> dict[str, bytes]:
    """The figures that can be drawn from the rows, as the bytes of files; equal rows give equal bytes.

    Args:
        kind: "png", "svg" or "pdf".

    Returns:
        By name: "steps" needs a ladder of steps, "speed" the boxes and the stack.
    """
    usable = [row for row in rows if row.ok]
    kinds = (
        ("steps", any(_ladders(usable, test) for test in _TESTS), _steps),
        ("speed", bool(_costs(usable)), _speed),
    )
    return {name: file_of(partial(draw, usable), kind) for name, enough, draw in kinds if enough}


# -- error against step ----------------------------------------------------------------------------------

_TESTS = {"free-fall": "free fall: distance", "pendulum": "pendulum: place"}


def _ladders(rows: Sequence[Row], test: str) -> dict[str, list[tuple[float, float]]]:
    """(step, error in per cent) of each well-set engine that was measured at three steps or more."""
    found: dict[str, list[tuple[float, float]]] = {}
    for row in rows:
        if row.scenario == test and row.setting == TUNED and row.value is not None:
            found.setdefault(row.engine, []).append((row.dt, abs(row.value)))
    return {engine: sorted(points) for engine, points in found.items() if len(points) >= 3}


def _steps(rows: Sequence[Row]) -> Figure:
    tests = [test for test in _TESTS if _ladders(rows, test)]
    figure, panels = new_figure(4.0, 1, len(tests), sharey=True, left=0.115, right=0.985, wspace=0.1)
    if len(tests) == 1:  # which has a heading, too
        figure.subplots_adjust(top=figure.subplotpars.top - 0.05)
    for axes, test in zip(panels, tests, strict=True):
        groups = grouped(_ladders(rows, test).items(), _alike)
        for engines, points in groups:
            _curve(axes, engines, points)
        _frame_steps(axes, _TESTS[test], [point for _engines, points in groups for point in points])
    # The names are placed by the limits that both panels share.
    for axes, test in zip(panels, tests, strict=True):
        _names(figure, axes, grouped(_ladders(rows, test).items(), _alike))
    panels[0].set_ylabel("error (%)")
    return title(figure, "The slope is the order of the method: most engines are first order")


def _alike(one: list[tuple[float, float]], other: list[tuple[float, float]]) -> bool:
    """Whether two curves look like one over ten decades."""
    (one_dt, one_error), (other_dt, other_error) = zip(*one, strict=True), zip(*other, strict=True)
    return one_dt == other_dt and np.allclose(one_error, other_error, rtol=_ALIKE)


def _curve(axes: Axes, engines: list[str], points: list[tuple[float, float]]) -> None:
    """One line for a group of engines."""
    dt = np.array([dt for dt, _ in points])
    error = np.maximum([e for _, e in points], _FLOOR)
    name, marker = _look(engines)
    color = PALETTE[name]
    axes.loglog(dt, error, color=color, linewidth=1.4 if len(engines) == 1 else 2.2)
    axes.loglog(dt, error, linestyle="none", marker=marker, color=color, markerfacecolor="white")


def _look(engines: list[str]) -> tuple[str, str]:
    """Colour and marker: an engine's own, or black for several."""
    return _LOOKS[engines[0]] if len(engines) == 1 else ("black", "o")


def _names(figure: Figure, axes: Axes, groups: list[tuple[list[str], list[tuple[float, float]]]]) -> None:
    """The name of each curve, below it from its second point on, where a rising curve leaves room.

    A short ladder needs all of the width: there names begin at the first point, below the whole curve. Curves
    that lie closer together than their names are high have them in a block below the lowest.
    """
    low, high = (math.log10(limit) for limit in axes.get_ylim())
    line = (high - low) * _LINE_IN / (axes.get_position().height * figure.get_figheight())  # decades
    blocks: list[tuple[float, list[tuple[str, str]]]] = []
    first = 1 if len(groups[0][1]) >= len(LADDER) else 0
    lowest = {id(points): min(e for _, e in points[first:]) for _engines, points in groups}
    for engines, points in sorted(groups, key=lambda group: -lowest[id(group[1])]):
        names = [ENGINES[engine].name for engine in engines]
        errors = [e for _, e in points]
        order = slope([(dt, e / 100.0) for dt, e in points], single=ENGINES[engines[0]].single)
        # Where a smaller step gives a larger error, the figure shows rounding, not a method.
        if order is not None and errors == sorted(errors):
            names[-1] += f": order {order:.1f}"
        words = _wrapped(names)
        level = math.log10(max(lowest[id(points)], _FLOOR))
        entry = (words, INK[_look(engines)[0]])
        if blocks and level > blocks[-1][0] - line * _lines(blocks[-1][1]):
            blocks[-1] = (level, [*blocks[-1][1], entry])
        else:
            blocks.append((level, [entry]))
    x = 1.06 * groups[0][1][first][0]
    for level, entries in blocks:
        top = level - 0.3 * line
        for words, ink in entries:
            axes.text(x, 10.0**top, words, color=ink, fontsize=8.5, va="top")
            top -= line * _lines([(words, ink)])


def _lines(entries: list[tuple[str, str]]) -> float:
    """How many lines high, with a little air below each entry."""
    return sum(1.15 + words.count("\n") for words, _ink in entries)


def _wrapped(names: list[str]) -> str:
    """Names of a group, as many to a line as fit beside a curve; none is broken."""
    lines = [names[0]]
    for name in names[1:]:
        if len(lines[-1]) + len(name) > _LINE_LETTERS:
            lines.append(name)
        else:
            lines[-1] += f", {name}"
    return ",\n".join(lines)


def _frame_steps(axes: Axes, name: str, points: list[tuple[float, float]]) -> None:
    axes.set(xlabel="step (s)", title=name)
    axes.margins(x=0.08, y=0.1)
    # A guide for the eye: an error that halves with the step.
    known = sorted({dt for dt, _ in points})
    low, high = known[0], known[-1]
    top = 3.0 * max(error for _, error in points)
    axes.loglog([low, high], [top * low / high, top], color=PALETTE["grey"], linewidth=0.8, linestyle=":")
    axes.annotate(
        "halves with the step",
        (math.sqrt(low * high), top * math.sqrt(low / high)),
        xytext=(-4, 5),
        textcoords="offset points",
        ha="right",
        color=PALETTE["grey"],
        fontsize=8.5,
    )
    axes.set_xticks(known, [_fraction(dt) for dt in known])
    axes.minorticks_off()


def _fraction(dt: float) -> str:
    rate = 1.0 / dt
    return f"1/{rate:.0f}" if math.isclose(rate, round(rate), rel_tol=1e-6) else f"{dt:g}"


# -- speed against accuracy ------------------------------------------------------------------------------


def _costs(rows: Sequence[Row]) -> dict[str, list[tuple[str, float, float]]]:
    """Per engine: (setting, rate as a multiple of pymunk's, movement of the stack in mm)."""
    found: dict[str, list[tuple[str, float, float]]] = {}
    for setting in (DEFAULT, TUNED):
        rate, moved = (
            {row.engine: row.value for row in rows if row.scenario == name and row.setting == setting}
            for name in (BOXES, "stack")
        )
        for engine in ENGINES:
            x, y = rate.get(engine), moved.get(engine)
            if x is not None and y is not None:
                found.setdefault(engine, []).append((setting, x, y))
    return found


def _speed(rows: Sequence[Row]) -> Figure:
    figure, panels = new_figure(4.4, left=0.115, top=0.885)
    axes = panels[0]
    for engine, points in _costs(rows).items():
        color = PALETTE[_LOOKS[engine][0]]
        x, y = np.array([p[1] for p in points]), np.maximum([p[2] for p in points], 1e-4)
        if len(points) == 2 and not np.allclose(y[0], y[1], rtol=0.02):
            arrow = {"arrowstyle": "-|>", "color": color, "linewidth": 1.3, "shrinkA": 5, "shrinkB": 4}
            axes.annotate("", xy=(x[1], y[1]), xytext=(x[0], y[0]), arrowprops=arrow)
            axes.loglog(x[:1], y[:1], "o", color=color, markerfacecolor="white", markeredgewidth=1.4)
            axes.loglog(x[1:], y[1:], "D", color=color, markersize=4.5)
        else:
            axes.loglog(x[:1], y[:1], "D", color=color, markersize=4.5)
        axes.annotate(
            ENGINES[engine].name,
            (x[0], y[0]),
            xytext=(7, 4),
            textcoords="offset points",
            color=INK[_LOOKS[engine][0]],
            fontsize=8.5,
            # A letter stays readable where an arrow crosses it.
            path_effects=[withStroke(linewidth=2.5, foreground="white")],
            zorder=4,
        )
    axes.set_xlabel("rate with a hundred boxes, as a multiple of pymunk's   (faster to the right)")
    axes.set_ylabel("largest movement in a stack of ten (mm)")
    axes.margins(x=0.08, y=0.12)
    # The name of the fastest stands to its right.
    axes.set_xlim(right=2.6 * max(x for points in _costs(rows).values() for _setting, x, _y in points))
    axes.plot([], [], "o", color=PALETTE["grey"], markerfacecolor="white", label="as it comes")
    axes.plot([], [], "D", color=PALETTE["grey"], label="well set for a stack")
    axes.legend(loc="lower right")
    return title(figure, "A stack can be made to stand still; most engines pay for it with speed")
