"""Figures of the lesson on contact models: a ball at rest, a bounce at every phase, friction from above."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from course.figures.drawing.style import PALETTE, new_figure, title
from course.physics.contact.models import Constraint, Penalty, SoftConvex, drop, erp_cfm, slide_across

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

__all__ = ["PHASES", "cone", "phases", "rebounds", "rest"]

_STEP_S, _G = 0.01, 9.81
_STIFFNESS, _DAMPING = 1e4, 20.0  # N/m and N s/m under a ball of 1 kg
#: Where in a step the ball arrives, as shares of it.
PHASES = (np.arange(80) + 0.5) / 80


def rest() -> Figure:
    """How deep a ball lies in the floor, over time, for four contact models."""
    figure, (axes,) = new_figure(3.4)
    erp, cfm = erp_cfm(_STIFFNESS, _DAMPING, _STEP_S)
    models = (
        ("penalty spring", Penalty(_STIFFNESS, _DAMPING), "vermillion", "-", 0.125, 1.5),
        ("ERP and CFM of that spring", Constraint(erp=erp, cfm=cfm), "blue", "--", 0.225, 1.15),
        ("soft convex (MuJoCo)", SoftConvex(), "green", "-.", 0.245, 0.5),
        ("constraint", Constraint(), "black", "-", 0.245, 0.09),
    )
    for name, model, color, line, x, y in models:
        gaps, _ = drop(model, 0.0, 0.0, _STEP_S, 40, _G)
        depth = -1000 * gaps
        axes.plot(_STEP_S * np.arange(depth.size), depth, color=PALETTE[color], linestyle=line, linewidth=1.8)
        axes.text(x, y, name, fontsize=8.5, fontweight="bold", color=_INK.get(color, PALETTE[color]))
    axes.set(xlim=(0, 0.4), ylim=(1.85, -0.1), xticks=[0.0, 0.1, 0.2, 0.3, 0.4])
    axes.set_xlabel("time since the ball was laid down (s)")
    axes.set_ylabel("depth in the floor (mm)")
    title(figure, "How deep a resting ball lies depends on the contact model")
    return figure


_INK = {"vermillion": "#B34F00", "green": "#007A58"}  # dark enough for letters


def rebounds(model: Constraint, parts: Array = PHASES, h: float = _STEP_S) -> Array:
    """First rebounds, as shares of the height, of a ball dropped from 1 m and a fraction of a step more."""
    tops = []
    for part in parts:
        height = 1.0 + float(part) * h * math.sqrt(2 * _G)
        gaps, speeds = drop(model, height, 0.0, h, round(1.1 / h), _G)
        tops.append(float(gaps[int(np.argmax(speeds > 0)) :].max()) / height)
    return np.array(tops)


def phases() -> Figure:
    """The rebound over the phase of the step: exact, looked at once a step, and with correction."""
    figure, (axes,) = new_figure(3.6)
    plain, corrected = rebounds(Constraint(0.5)), rebounds(Constraint(0.5, erp=0.2))
    for values, color, line in ((plain, "blue", "-"), (corrected, "vermillion", "--")):
        # The tooth's edge is a jump, so no line is drawn across it.
        broken = np.where(np.abs(np.diff(values, prepend=values[0])) > 0.02, np.nan, values)
        axes.plot(PHASES, broken, color=PALETTE[color], linestyle=line, linewidth=1.8)
    axes.axhline(0.25, color=PALETTE["black"], linewidth=1.2)
    axes.text(0.99, 0.257, "event-driven: 0.25", ha="right", fontsize=8.5, fontweight="bold")
    axes.text(
        0.99, 0.188, "once a step, no correction", ha="right", fontsize=8.5, fontweight="bold",
        color=PALETTE["blue"],
    )  # fmt: skip
    axes.text(
        0.62, 0.43, "ERP 0.2 in the velocity", fontsize=8.5, fontweight="bold", color=_INK["vermillion"]
    )
    axes.set(xlim=(-0.01, 1.0), ylim=(0.16, 0.5))
    axes.set_xlabel("start, in parts of a step's fall (no unit)")
    axes.set_ylabel("rebound (share of the height)")
    title(figure, "How high a ball bounces depends on when the engine looks")
    return figure


def cone() -> Figure:
    """Paths of a sliding block from above, with a friction cone and with two pyramids."""
    figure, (axes,) = new_figure(4.2)
    shapes = (
        ("cone", "cone", "blue", "-", "o"),
        ("outer", "pyramid around it", "vermillion", "--", "s"),
        ("inner", "pyramid within it", "green", "-.", "^"),
    )
    for degrees in (0, 20, 45, 70, 90):
        for limit, name, color, line, mark in shapes:
            path = slide_across(math.radians(degrees), 2.0, 0.3, 0.001, limit=limit)
            label = name if degrees == 20 else None
            axes.plot(*path.T, color=PALETTE[color], linestyle=line, linewidth=1.8, label=label)
            axes.plot(*path[-1], color=PALETTE[color], marker=mark, markersize=5)
    turn = np.radians(np.arange(91))
    reach = 2.0**2 / (2 * 0.3 * _G)
    axes.plot(reach * np.cos(turn), reach * np.sin(turn), color=PALETTE["grey"], linewidth=0.8)
    axes.text(0.70, 0.14, "v² / (2 μ g)", fontsize=8.5, color=PALETTE["grey"])
    axes.set(xlim=(-0.03, 1.15), ylim=(-0.03, 0.74), aspect="equal")
    axes.legend(loc="upper right", handlelength=3.0, title="friction by a")
    axes.set_xlabel("x, an axis of the pyramid (m)")
    axes.set_ylabel("y (m)")
    title(figure, "Along its diagonal a friction pyramid is too strong or too weak")
    return figure
