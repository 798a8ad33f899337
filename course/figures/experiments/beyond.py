"""Figures of the simulations that go beyond an introduction; ``basic`` calls them."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from course.figures.drawing.style import METHODS, PALETTE, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from course.simulations.base import Result

__all__ = ["chaos", "contact_models", "dynamics", "environment", "rotation", "solver_iterations", "substeps"]

#: A curve that grows past this leaves the picture; matplotlib cannot scale to more. In shares.
_TALLEST = 1e12
#: Looks for series that are not methods of integration, in the order they are used.
_LOOKS = (
    (PALETTE["blue"], "-"),
    (PALETTE["vermillion"], "--"),
    (PALETTE["green"], "-."),
    (PALETTE["purple"], ":"),
    (PALETTE["orange"], (0, (5, 1, 1, 1, 1, 1))),
    (PALETTE["black"], (0, (1, 1))),
)


def rotation(result: Result) -> Figure:
    """Angular velocity about each axis, and the energy error of each method."""
    figure, (upper, lower) = new_figure(5.0, 2, 1, sharex=True)
    t = result.column("t")
    for k, (color, line) in zip((2, 1, 3), _LOOKS[:3], strict=True):
        width = 1.8 if k == 2 else 1.0
        upper.plot(t, result.column(f"w{k}"), color=color, linestyle=line, linewidth=width, label=f"axis {k}")
    upper.set(ylabel="angular velocity\nin the body's axes (rad/s)")
    upper.legend(loc="center left", bbox_to_anchor=(1.0, 0.5))
    names = {"explicit_euler": "explicit Euler", "split": "split rotations", "rk4": "Runge-Kutta 4"}
    for name, label in names.items():
        look = METHODS["velocity_verlet" if name == "split" else name]
        drift = 100 * np.minimum(result.column(f"energy_error_{name}"), _TALLEST)
        lower.plot(
            t, np.where(np.isfinite(drift), drift, np.nan), color=look.color, linestyle=look.line,
            label=label,
            linewidth=3.2 if name == "split" else 1.6,  # the other one lies on top of it
        )  # fmt: skip
    lower.set(xlabel="time (s)", ylabel="energy gained (%)")
    lower.legend(loc="center left", bbox_to_anchor=(1.0, 0.5))
    figure.subplots_adjust(left=0.13, right=0.75, top=0.93)
    return figure


def dynamics(result: Result) -> Figure:
    """The arm at a few moments with the planned and the forward path of its hand, and the torques."""
    figure, (left, right) = new_figure(3.4, 1, 2)
    t = result.column("t")
    hand = np.stack([result.column("hand_x"), result.column("hand_y")], axis=-1)
    q1 = result.column("q1")
    for i in np.linspace(0, t.size - 1, 5).astype(int):
        elbow = (math.cos(q1[i]), math.sin(q1[i]))
        left.plot([0, elbow[0], hand[i, 0]], [0, elbow[1], hand[i, 1]], color=PALETTE["grey"], linewidth=0.9,
                  marker="o", markersize=3)  # fmt: skip
    left.plot(hand[:, 0], hand[:, 1], color=PALETTE["blue"], linewidth=2.6, label="hand, forward run")
    left.plot(result.column("planned_x"), result.column("planned_y"), color=PALETTE["vermillion"],
              linestyle="--", label="hand, planned")  # fmt: skip
    left.set(
        xlabel="x (m)",
        ylabel="y (m)",
        title="The hand and the arm",
        xlim=(-1.6, 2.2),
        ylim=(-1.9, 1.9),
        aspect="equal",
    )
    left.legend(loc="lower left", fontsize=8)
    for k, (color, line) in ((1, _LOOKS[0]), (2, _LOOKS[1])):
        joint = ("shoulder", "elbow")[k - 1]
        right.plot(t, result.column(f"torque{k}"), color=color, linestyle=line, label=joint)
    right.set(xlabel="time (s)", ylabel="torque (N m)", title="What inverse dynamics asks for")
    right.legend(loc="best")
    figure.subplots_adjust(wspace=0.3)
    return figure


def chaos(result: Result) -> Figure:
    """The lower rods of both pendulums, and how far apart the pendulums are."""
    figure, (upper, lower) = new_figure(5.0, 2, 1, sharex=True)
    t, apart = result.column("t"), result.column("separation")
    upper.plot(t, result.column("angle2_a"), color=PALETTE["blue"], linewidth=2.4, label="first")
    upper.plot(t, result.column("angle2_b"), color=PALETTE["vermillion"], linestyle="--", label="second")
    upper.set(ylabel="angle of the lower rod (rad)")
    upper.legend(loc="best", title="pendulum")
    lower.plot(t, np.where(apart > 0, apart, np.nan), color=PALETTE["black"])
    for level, row, (color, line) in zip((1e-3, 1.0), result.rows[:2], _LOOKS[1:3], strict=True):
        if math.isfinite(row.simulated):
            lower.plot(
                [row.simulated], [level], marker="o", markersize=8, markerfacecolor="none", color=color,
                linestyle="none", label=f"{level:g} rad at {row.simulated:#.3g} s",
            )  # fmt: skip
        lower.axhline(level, color=color, linewidth=0.8, linestyle=line)
    lower.set(xlabel="time (s)", ylabel="separation (rad)", yscale="log")
    if any(math.isfinite(row.simulated) for row in result.rows[:2]):
        lower.legend(loc="lower right")
    figure.subplots_adjust(top=0.93)
    return figure


def solver_iterations(result: Result) -> Figure:
    """The share of its weight that the ground feels under each stack, over the iterations."""
    figure, (axes,) = new_figure(3.8)
    stacks = [column for column in result.columns if column.name.startswith("load_")]
    iteration = result.column("iteration")
    for column, (color, line) in zip(stacks, _LOOKS, strict=False):
        boxes = column.name.split("_")[1]
        needed = int(
            result.row(
                next(r.quantity for r in result.rows if r.quantity.endswith(f", {boxes} boxes"))
            ).simulated
        )
        axes.plot(
            iteration[1:],
            100 * column.values[1:],
            color=color,
            linestyle=line,
            label=f"{boxes} boxes: {needed}",
        )
        if needed < iteration.size:
            axes.plot([needed], [100 * column.values[needed]], marker="o", color=color, linestyle="none")
    tolerance = float(result.settings["tolerance"])
    axes.axhline(100 * (1 - tolerance), color=PALETTE["black"], linewidth=0.8)
    axes.set(
        xscale="log",
        xlabel="iterations done (count)",
        ylabel="share of the weight that\nreaches the ground (%)",
    )
    axes.set_ylim(0, 105)
    axes.legend(
        loc="center left", bbox_to_anchor=(1.0, 0.5), title=f"iterations to\n{100 * (1 - tolerance):g} %"
    )
    figure.subplots_adjust(left=0.14, right=0.76)
    return figure


def substeps(result: Result) -> Figure:
    """Stretch of the longest link over time, for each way to spend the work."""
    figure, (axes,) = new_figure(3.6)
    t = result.column("t")
    for column, (color, line) in zip(result.columns[1:], _LOOKS, strict=False):
        steps, sweeps = column.name.removeprefix("stretch_").split("x")
        axes.plot(t, 100 * column.values, color=color, linestyle=line, label=f"{steps} x {sweeps}")
    axes.set(xlabel="time (s)", ylabel="stretch of the longest link (%)")
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), title="substeps x\niterations")
    figure.subplots_adjust(right=0.82)
    return figure


def environment(result: Result) -> Figure:
    """Stopping distance over friction and rebound over restitution, each with theory."""
    figure, (left, right) = new_figure(3.3, 1, 2)
    _beside_theory(left, result, "stopping_distance", "v² / (2 μ g)")
    left.set(xlabel="friction μ (no unit)", ylabel="distance slid (m)", title="A block slides to rest")
    _beside_theory(right, result, "rebound", "e² times the drop")
    right.set(xlabel="restitution e (no unit)", ylabel="height of the rebound (m)", title="A ball bounces")
    figure.subplots_adjust(wspace=0.3)
    return figure


def contact_models(result: Result) -> Figure:
    """Rebound and energy kept over the phase of the step, for three ways to correct an overlap."""
    figure, (left, right) = new_figure(3.3, 1, 2)
    phase = result.column("phase")
    # Without correction and with split impulse the velocities are the same, unless a bounce is that slow.
    looks = (("erp", "ERP in the velocity"), ("split", "split impulse"), ("none", "no correction"))
    for (name, label), (color, line) in zip(
        looks, (("vermillion", "--"), ("sky", "-"), ("blue", ":")), strict=True
    ):
        style: dict[str, Any] = {"color": PALETTE[color], "linestyle": line, "linewidth": 2.2, "label": label}
        left.plot(phase, result.column(f"rebound_{name}"), **style)
        right.plot(phase, result.column(f"kept_{name}"), **style)
    left.axhline(float(result.settings["restitution"]) ** 2, color=PALETTE["black"], linewidth=1.0)
    right.axhline(1.0, color=PALETTE["black"], linewidth=1.0)
    left.set(xlabel="phase of the step (no unit)", ylabel="rebound (share)", title="A ball bounces")
    right.set(xlabel="phase of the step (no unit)", ylabel="energy kept (share)", title="An elastic one")
    left.set_ylim(bottom=0.0)
    right.set_ylim(bottom=0.0)
    right.legend(loc="lower right")
    figure.subplots_adjust(wspace=0.3)
    return figure


def _beside_theory(axes: Axes, result: Result, name: str, formula: str) -> None:
    x = result.column("coefficient")
    axes.plot(x, result.column(f"{name}_theory"), color=PALETTE["black"], linewidth=1.0, label=formula)
    axes.plot(x, result.column(name), color=PALETTE["blue"], linestyle="none", marker="o", label="simulated")
    axes.legend(loc="best")
