"""Figures of the lesson on accuracy: a step that is too small, how to spend work, paths and statistics."""

from __future__ import annotations

import math
from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from course.figures.drawing.style import PALETTE, new_figure, note, title
from course.physics.dynamics import PassiveArm, TwoLinkArm
from course.physics.integrators import RK4, State, trajectory
from course.physics.solver import Chain

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

__all__ = ["NUDGE", "STARTS", "chaos", "fall_error", "small_steps", "splits", "substeps", "swing"]

#: What the figures show and the lesson quotes: rad between two pendulums, and how many make a crowd.
NUDGE, STARTS = 1e-9, 400
#: Angles of both rods from hanging, degrees, and how far apart a crowd starts, rad.
_LET_GO, _SPREAD = (160.0, -95.0), 1e-3
_WORK = 16  # sweeps over the chain a frame


def fall_error(step: float, kind: type[np.floating], g: float = 9.81) -> float:
    """Error of semi-implicit Euler after a fall of 2 s, in m, with numbers of this precision."""
    n = round(2.0 / step)
    h = kind(step)
    v = np.cumsum(np.full(n, -h * kind(g), dtype=kind), dtype=kind)  # adds one by one, as a loop does
    z = np.cumsum(h * v, dtype=kind)
    return abs(float(z[-1]) + 0.5 * g * 2.0**2)


@cache
def _typical_error(step: float, kind: type[np.floating]) -> float:
    """Root mean square of the error over 25 gravities: at a single one, roundings may cancel by luck."""
    return float(np.sqrt(np.mean([fall_error(step, kind, g) ** 2 for g in np.linspace(9.6, 10.0, 25)])))


def small_steps() -> Figure:
    """Error of a fall over the step, in single and in double precision."""
    figure, (axes,) = new_figure(3.9)
    steps = 2.0 ** -np.arange(3, 19)
    for kind, line, marker, color in ((np.float64, "-", "s", "blue"), (np.float32, "--", "o", "vermillion")):
        errors = [_typical_error(float(h), kind) for h in steps]
        axes.plot(steps, errors, color=PALETTE[color], linestyle=line, marker=marker)
    axes.text(1.3e-4, 3.5e-4, "double precision", color=PALETTE["blue"], fontweight="bold", fontsize=8.5)
    axes.text(4.4e-6, 3.2e-1, "single precision", color="#B34F00", fontweight="bold", fontsize=8.5)
    best = float(min(steps, key=lambda h: _typical_error(float(h), np.float32)))
    lowest = (best, _typical_error(best, np.float32))
    note(axes, "best step in\nsingle precision", lowest, (2.2e-4, 3e-2), PALETTE["black"])
    axes.set(xscale="log", yscale="log", xlim=(3e-6, 0.2), ylim=(2e-5, 3))
    axes.set_xlabel("step h (s)")
    axes.set_ylabel("error of the height after 2 s (m)")
    title(figure, "In single precision a step can be too small: rounding takes over")
    return figure


@cache
def splits() -> tuple[tuple[int, int, float], ...]:
    """Substeps, iterations and the greatest stretch of a link (share): equal work over 2 s."""
    halves = range(round(math.log2(_WORK)) + 1)
    pairs = [(2**k, _WORK // 2**k) for k in halves]
    return tuple((s, i, float(Chain().stretch(2.0, 1 / 60, s, i).max())) for s, i in pairs)


def substeps() -> Figure:
    """Greatest stretch of a chain for five ways to spend sixteen sweeps a frame."""
    figure, (axes,) = new_figure(3.4)
    rows = splits()
    places = range(len(rows))
    axes.bar(
        places, [100 * stretch for _, _, stretch in rows], color=PALETTE["sky"], edgecolor=PALETTE["blue"]
    )
    for x, (_, _, stretch) in zip(places, rows, strict=True):
        axes.text(
            x, 100 * stretch + 0.15, f"{100 * stretch:.1f} %", ha="center", fontsize=8.5, fontweight="bold"
        )
    axes.set_xticks(places, [f"{s} × {i}" for s, i, _ in rows])
    axes.set(ylim=(0, 9.6))
    axes.grid(visible=False, axis="x")
    axes.set_xlabel("substeps × iterations (number each frame)")
    axes.set_ylabel("greatest stretch of a link (%)")
    title(figure, "For the same work, many small steps beat many iterations")
    return figure


def swing(starts: Array, step: float, duration: float) -> tuple[Array, Array]:
    """Release double pendulums, all at once.

    Args:
        starts: angles of both rods from hanging, rad, shape (..., 2).

    Returns:
        Times (n + 1,) and the angles from hanging (n + 1, ..., 2).
    """
    joints = np.stack([starts[..., 0] - math.pi / 2, starts[..., 1] - starts[..., 0]], axis=-1)
    pendulum = PassiveArm(TwoLinkArm.double_pendulum())
    run = trajectory(RK4(), pendulum, State.at_rest(joints), step, round(duration / step))
    return run.t, np.cumsum(run.q, axis=-1) + math.pi / 2


@cache
def _crowd(step: float) -> tuple[float, ...]:
    """Share of time (%) that the lower rods of a crowd point in each of 18 directions, from 8 s to 15 s.

    By then the paths of different steps have parted; those of different machines, by rounding, have not yet.
    """
    start = np.radians(_LET_GO) + _SPREAD * np.random.default_rng(1).standard_normal((STARTS, 2))
    t, angles = swing(start, step, 15.0)
    lower = (angles[t >= 8.0, :, 1] + math.pi) % (2 * math.pi) - math.pi
    counts, _ = np.histogram(lower, bins=18, range=(-math.pi, math.pi))
    return tuple(100 * counts / lower.size)


def chaos() -> Figure:
    """Two paths a billionth apart, and the statistics of two crowds integrated with different steps."""
    figure, (left, right) = new_figure(3.7, 1, 2)
    figure.subplots_adjust(wspace=0.26)
    pair = np.radians(_LET_GO) + np.array([[0.0, 0.0], [NUDGE, 0.0]])
    t, angles = swing(pair, 0.005, 15.0)
    apart = np.max(np.abs(angles[:, 1] - angles[:, 0]), axis=-1)
    left.plot(t[1:], apart[1:], color=PALETTE["blue"], linewidth=1.2)
    for level, text, place in ((1e-3, "a thousandth", (0.4, 3e-2)), (1.0, "1 rad", (4.2, 2.0e1))):
        when = float(t[np.argmax(apart > level)])
        left.plot([when], [level], marker="o", color=PALETTE["black"])
        note(left, f"{text}\nat {when:.1f} s", (when, level), place, PALETTE["black"])
    left.set(yscale="log", xlim=(0, 15), ylim=(1e-10, 1e3))
    left.set_title("Two paths drift apart")
    left.set_xlabel("time (s)")
    left.set_ylabel("difference of the angles (rad)")
    edges = np.linspace(-180, 180, 19)
    right.stairs(_crowd(0.02), edges, color=PALETTE["vermillion"], linewidth=2.6)
    right.stairs(_crowd(0.01), edges, color=PALETTE["black"], linewidth=1.2, linestyle="--")
    right.text(-170, 9.4, f"{STARTS} starts, step 0.02 s", color="#B34F00", fontweight="bold", fontsize=8.5)
    right.text(-170, 8.7, "the same, step 0.01 s (dashed)", fontsize=8.5)
    right.set(xlim=(-180, 180), ylim=(0, 10.4), xticks=(-90, 0, 90))
    right.set_title("Two crowds: equal statistics")
    right.set_xlabel("lower rod from hanging (degrees)")
    right.set_ylabel("share of the time (%)")
    title(figure, "In chaos no path can be checked, but statistics can be")
    return figure
