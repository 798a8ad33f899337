"""Figures of the simulations: one for each, drawn from its result, for any settings.

``render`` serves ``course sim run --plot``; the others draw a simulation as lessons set it.
"""

import functools
import math
from collections.abc import Callable
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from course.errors import InternalError
from course.figures.style import METHODS, PALETTE, Array, file_of, new_figure, title
from course.simulations.base import Result, run
from course.simulations.registry import get

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


#: What draws the result of a simulation, by its id.
_DRAWERS: dict[str, Callable[[Result], Figure]] = {}


def _draws(name: str, *pairs: str) -> Callable[[Callable[[Result], Figure]], Callable[[], Figure]]:
    """Marks what draws the results of a simulation; called by itself it draws the one that a lesson shows."""

    def enter(drawer: Callable[[Result], Figure]) -> Callable[[], Figure]:
        _DRAWERS[name] = drawer

        @functools.wraps(drawer, updated=())
        def build() -> Figure:
            return draw(run(get(name), pairs))

        return build

    return enter


@_draws("rotation")
def rotation(result: Result) -> Figure:
    """Angular velocity about each axis, and the energy error of each method."""
    figure, (upper, lower) = new_figure(5.0, 2, 1, sharex=True, left=0.13, right=0.75, top=0.93)
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
    return figure


@_draws("dynamics", "payload=0.01")
def dynamics(result: Result) -> Figure:
    """The arm at a few moments with the planned and the forward path of its hand, and the torques."""
    figure, (left, right) = new_figure(3.4, 1, 2, wspace=0.3)
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
    left.set(xlabel="x (m)", ylabel="y (m)", title="The hand and the arm")
    left.set(xlim=(-1.6, 2.2), ylim=(-1.9, 1.9), aspect="equal")
    left.legend(loc="lower left", fontsize=8)
    for k, (color, line) in ((1, _LOOKS[0]), (2, _LOOKS[1])):
        joint = ("shoulder", "elbow")[k - 1]
        right.plot(t, result.column(f"torque{k}"), color=color, linestyle=line, label=joint)
    right.set(xlabel="time (s)", ylabel="torque (N m)", title="What inverse dynamics asks for")
    right.legend(loc="best")
    return figure


@_draws("chaos")
def chaos(result: Result) -> Figure:
    """The lower rods of both pendulums, and how far apart the pendulums are."""
    figure, (upper, lower) = new_figure(5.0, 2, 1, sharex=True, top=0.93)
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
    return figure


@_draws("solver-iterations")
def solver_iterations(result: Result) -> Figure:
    """The share of its weight that the ground feels under each stack, over the iterations."""
    figure, (axes,) = new_figure(3.8, left=0.14, right=0.76)
    stacks = [column for column in result.columns if column.name.startswith("load_")]
    iteration = result.column("iteration")
    for column, (color, line) in zip(stacks, _LOOKS, strict=False):
        boxes = column.name.split("_")[1]
        needed = int(next(row.simulated for row in result.rows if row.quantity.endswith(f", {boxes} boxes")))
        label = f"{boxes} boxes: {needed}"
        axes.plot(iteration[1:], 100 * column.values[1:], color=color, linestyle=line, label=label)
        if needed < iteration.size:
            axes.plot([needed], [100 * column.values[needed]], marker="o", color=color, linestyle="none")
    tolerance = float(result.settings["tolerance"])
    axes.axhline(100 * (1 - tolerance), color=PALETTE["black"], linewidth=0.8)
    axes.set(xscale="log", ylim=(0, 105))
    axes.set(xlabel="iterations done (count)", ylabel="share of the weight that\nreaches the ground (%)")
    until = f"iterations to\n{100 * (1 - tolerance):g} %"
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), title=until)
    return figure


@_draws("substeps")
def substeps(result: Result) -> Figure:
    """Stretch of the longest link over time, for each way to spend the work."""
    figure, (axes,) = new_figure(3.6, right=0.82)
    t = result.column("t")
    for column, (color, line) in zip(result.columns[1:], _LOOKS, strict=False):
        steps, sweeps = column.name.removeprefix("stretch_").split("x")
        axes.plot(t, 100 * column.values, color=color, linestyle=line, label=f"{steps} x {sweeps}")
    axes.set(xlabel="time (s)", ylabel="stretch of the longest link (%)")
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), title="substeps x\niterations")
    return figure


@_draws("environment")
def environment(result: Result) -> Figure:
    """Stopping distance over friction and rebound over restitution, each with theory."""
    figure, (left, right) = new_figure(3.3, 1, 2, wspace=0.3)
    _beside_theory(left, result, "stopping_distance", "v² / (2 μ g)")
    left.set(xlabel="friction μ (no unit)", ylabel="distance slid (m)", title="A block slides to rest")
    _beside_theory(right, result, "rebound", "e² times the drop")
    right.set(xlabel="restitution e (no unit)", ylabel="height of the rebound (m)", title="A ball bounces")
    return figure


@_draws("contact-models")
def contact_models(result: Result) -> Figure:
    """Rebound and energy kept over the phase of the step, for three ways to correct an overlap."""
    figure, (left, right) = new_figure(3.3, 1, 2, wspace=0.3)
    phase = result.column("phase")
    # Without correction and with split impulse the velocities are the same, unless a bounce is that slow.
    looks = (
        ("erp", "ERP in the velocity", "vermillion", "--"),
        ("split", "split impulse", "sky", "-"),
        ("none", "no correction", "blue", ":"),
    )
    for name, label, color, line in looks:
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
    return figure


def _beside_theory(axes: Axes, result: Result, name: str, formula: str) -> None:
    x = result.column("coefficient")
    axes.plot(x, result.column(f"{name}_theory"), color=PALETTE["black"], linewidth=1.0, label=formula)
    axes.plot(x, result.column(name), color=PALETTE["blue"], linestyle="none", marker="o", label="simulated")
    axes.legend(loc="best")


def render(result: Result, kind: str) -> bytes:
    """The figure of a result as the bytes of a file; the same result gives the same bytes."""
    return file_of(lambda: draw(result), kind)


@_draws("free-fall")
def free_fall(result: Result) -> Figure:
    t = result.column("t")
    figure, (left, right) = new_figure(3.2, 1, 2, wspace=0.36)
    every = max(1, t.size // 25)
    left.plot(t, result.column("height_theory"), color=PALETTE["black"], linewidth=1.0, label="theory")
    left.plot(
        t[::every], result.column("height")[::every], color=METHODS[str(result.settings["method"])].color,
        linestyle="none", marker="o", markersize=4, label=f"every {_nth(every)} sample",
    )  # fmt: skip
    left.set(xlabel="time (s)", ylabel="height (m)", title="With ground")
    left.legend(loc="lower left")
    for name, look in METHODS.items():
        wide = 3.2 if name == "velocity_verlet" else 1.6  # the dashes of Runge-Kutta lie on top of it
        error = result.column(f"error_{name}")
        right.plot(t, error, color=look.color, linestyle=look.line, linewidth=wide, label=look.name)
    right.set(xlabel="time (s)", ylabel="height less theory (m)", title="Without ground")
    right.legend(loc="upper left")
    low, high = right.get_ylim()
    right.set_ylim(low, high + 1.1 * (high - low) / 2)  # room for the legend above the curves
    return figure


def _nth(number: int) -> str:
    return "" if number == 1 else f"{number}th" if number > 3 else ("2nd", "3rd")[number - 2]


@_draws("projectile", "drag=0.02")
def projectile(result: Result) -> Figure:
    figure, (axes,) = new_figure(3.6, right=0.68)
    x, z = result.column("x"), result.column("z")
    every = max(1, x.size // 40)
    axes.plot(
        result.column("x_theory"), result.column("z_theory"), color=PALETTE["black"], linewidth=1.0,
        label="theory, no air",
    )  # fmt: skip
    axes.plot(
        x[::every], z[::every], color=PALETTE["blue"], marker="o", markersize=4, linestyle="none",
        label=f"simulated, every {every * float(result.settings['step']):.3g} s",
    )  # fmt: skip
    apex, top, out, _, far = result.rows
    if math.isfinite(top.simulated):
        axes.plot(
            [out.simulated], [top.simulated], marker="^", color=PALETTE["vermillion"], markersize=8,
            linestyle="none", label=f"top: {top.simulated:.4g} m at {apex.simulated:.4g} s",
        )  # fmt: skip
    if math.isfinite(far.simulated):
        axes.plot([far.simulated], [0.0], marker="s", color=PALETTE["vermillion"], markersize=7,
                  linestyle="none", label=f"landing: {far.simulated:.5g} m away")  # fmt: skip
    axes.set(xlabel="distance (m)", ylabel="height (m)")
    axes.set_ylim(bottom=min(0.0, float(np.min(z))) - 0.03 * float(np.ptp(z) or 1.0))
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5))
    return figure


@_draws("collision")
def collision(result: Result) -> Figure:
    figure, (axes,) = new_figure(3.8, right=0.68)
    t, radius = result.column("t"), float(result.settings["radius"])
    looks = (("x1", "left ball", PALETTE["blue"], "-"), ("x2", "right ball", PALETTE["orange"], "--"))
    for name, label, color, line in looks:
        x = result.column(name)
        axes.fill_between(t, x - radius, x + radius, color=color, alpha=0.25, linewidth=0)
        axes.plot(t, x, color=color, linestyle=line, label=f"{label} and its width")
    for name, _, _, _ in looks:
        straight = result.column(name)[0] + result.column(name.replace("x", "v"))[0] * t
        label = "points without size" if name == "x1" else "_"  # one entry is enough
        axes.plot(t, straight, color=PALETTE["grey"], linewidth=0.8, linestyle=":", label=label)
    met = result.rows[0].simulated
    if math.isfinite(met):
        axes.axvline(met, color=PALETTE["black"], linewidth=0.8)
        axes.plot([], [], color=PALETTE["black"], linewidth=0.8, label=f"contact at {met:.4g} s")
    axes.set(xlabel="time (s)", ylabel="position (m)")
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5))
    return figure


@_draws("integrators")
def integrators(result: Result) -> Figure:
    figure, (upper, lower) = new_figure(5.0, 2, 1, sharex=True, left=0.13, right=0.75, top=0.93)
    t, exact = result.column("t"), result.column("exact")
    for name, look in METHODS.items():
        error = _positive(np.abs(result.column(name) - exact))
        drift = _positive(np.abs(result.column(f"energy_error_{name}")))
        upper.plot(t, error, color=look.color, linestyle=look.line, label=look.name)
        # Verlet's error keeps returning to nothing; its largest so far shows what the method does.
        lower.plot(t, np.fmax.accumulate(drift), color=look.color, linestyle=look.line)
    upper.set(ylabel="position error (m)", yscale="log")
    lower.set(ylabel="largest energy error\nso far (share of E₀)", xlabel="time (s)", yscale="log")
    upper.legend(loc="center left", bbox_to_anchor=(1.0, 0.5))
    return figure


def _positive(values: Array) -> Array:
    """Values for a logarithmic axis: zeros and absurdly large ones are left out."""
    return np.where((values > 1e-17) & (values < 1e100), values, np.nan)


def draw(result: Result) -> Figure:
    """The figure of a result; call it inside ``house_style``."""
    if result.simulation not in _DRAWERS:
        raise InternalError(f"The simulation {result.simulation} has no figure.")
    figure = _DRAWERS[result.simulation](result)
    return title(figure, result.headline)
