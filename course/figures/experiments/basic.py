"""Figures of the simulations: one for each, drawn from its result, for any settings.

``render`` serves ``course sim run --plot``; ``of`` draws a simulation with its default settings, for lessons.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from course.errors import InternalError
from course.figures.drawing.style import METHODS, PALETTE, file_of, new_figure, title
from course.figures.experiments import beyond

if TYPE_CHECKING:
    from collections.abc import Callable

    from matplotlib.figure import Figure
    from numpy.typing import NDArray

    from course.simulations.base import Result

    Array = NDArray[np.float64]

__all__ = ["chaos", "collision", "contact_models", "draw", "dynamics", "environment", "free_fall",
           "integrators", "projectile", "render", "rotation", "solver_iterations", "substeps"]  # fmt: skip


def render(result: Result, kind: str) -> bytes:
    """The figure of a result as the bytes of a file; the same result gives the same bytes.

    Args:
        kind: "png", "svg" or "pdf".
    """
    return file_of(lambda: draw(result), kind)


def draw(result: Result) -> Figure:
    """The figure of a result; call it inside ``house_style``."""
    drawers: dict[str, Callable[[Result], Figure]] = {
        "free-fall": _free_fall,
        "projectile": _projectile,
        "collision": _collision,
        "integrators": _integrators,
        "rotation": beyond.rotation,
        "dynamics": beyond.dynamics,
        "chaos": beyond.chaos,
        "solver-iterations": beyond.solver_iterations,
        "substeps": beyond.substeps,
        "environment": beyond.environment,
        "contact-models": beyond.contact_models,
    }
    if result.simulation not in drawers:
        raise InternalError(f"The simulation {result.simulation} has no figure.")
    figure = drawers[result.simulation](result)
    title(figure, result.headline)
    return figure


def _of(name: str, *pairs: str) -> Figure:
    from course.simulations.registry import get
    from course.simulations.settings import run

    return draw(run(get(name), pairs))


def free_fall() -> Figure:
    """Height of a falling ball, and how far each method is off."""
    return _of("free-fall")


def projectile() -> Figure:
    """A throw with air, beside the one without, which theory solves."""
    return _of("projectile", "drag=0.02")


def collision() -> Figure:
    """Positions of two balls that meet head on."""
    return _of("collision")


def integrators() -> Figure:
    """Errors of position and energy of four methods on one spring."""
    return _of("integrators")


def rotation() -> Figure:
    """A body that turns over, and its energy by three methods."""
    return _of("rotation")


def dynamics() -> Figure:
    """An arm with a load that is not in its plan."""
    return _of("dynamics", "payload=0.01")


def chaos() -> Figure:
    """Two double pendulums that part."""
    return _of("chaos")


def solver_iterations() -> Figure:
    """How the weight of a stack reaches the ground, iteration by iteration."""
    return _of("solver-iterations")


def substeps() -> Figure:
    """Stretch of a chain for the same work spent in different ways."""
    return _of("substeps")


def environment() -> Figure:
    """Stopping distance over friction, and rebound over restitution."""
    return _of("environment")


def contact_models() -> Figure:
    """Rebound and kept energy over the phase of the step, for three ways to correct an overlap."""
    return _of("contact-models")


def _free_fall(result: Result) -> Figure:
    t = result.column("t")
    figure, (left, right) = new_figure(3.2, 1, 2)
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
        right.plot(
            t,
            result.column(f"error_{name}"),
            color=look.color,
            linestyle=look.line,
            linewidth=wide,
            label=look.name,
        )
    right.set(xlabel="time (s)", ylabel="height less theory (m)", title="Without ground")
    right.legend(loc="upper left")
    low, high = right.get_ylim()
    right.set_ylim(low, high + 1.1 * (high - low) / 2)  # room for the legend above the curves
    figure.subplots_adjust(wspace=0.36)
    return figure


def _nth(number: int) -> str:
    return "" if number == 1 else f"{number}th" if number > 3 else ("2nd", "3rd")[number - 2]


def _projectile(result: Result) -> Figure:
    figure, (axes,) = new_figure(3.6)
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
    axes.set_ylim(bottom=min(0.0, float(z.min())) - 0.03 * float(np.ptp(z) or 1.0))
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5))
    figure.subplots_adjust(right=0.68)
    return figure


def _collision(result: Result) -> Figure:
    figure, (axes,) = new_figure(3.8)
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
    figure.subplots_adjust(right=0.68)
    return figure


def _integrators(result: Result) -> Figure:
    figure, (upper, lower) = new_figure(5.0, 2, 1, sharex=True)
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
    figure.subplots_adjust(left=0.13, right=0.75, top=0.93)
    return figure


def _positive(values: Array) -> Array:
    """Values for a logarithmic axis: zeros and absurdly large ones are left out."""
    return np.where((values > 1e-17) & (values < 1e100), values, np.nan)
