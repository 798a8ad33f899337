"""Figure of the summary: what each source of error does to one number, the distance a robot needs to stop."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from course.figures.style import PALETTE, new_figure, title

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["budget", "costs", "stop"]

_SPEED, _FRICTION, _G = 2.0, 0.5, 9.81


def stop(
    h: float = 1e-5,
    *,
    speed: float = _SPEED,
    friction: float = _FRICTION,
    slope: float = 0.0,
    delay: float = 0.0,
) -> float:
    """Distance that a braking robot slides, m, by semi-implicit Euler.

    Args:
        h: step, s.
        speed: at which it is told to brake, m/s.
        friction: Coulomb's coefficient of the floor.
        slope: of the floor, downhill, rad.
        delay: between the command and the brake, s.
    """
    decline = _G * (friction * math.cos(slope) - math.sin(slope))
    distance = speed * delay
    while speed > 0.0:
        speed = max(speed - h * decline, 0.0)
        distance += h * speed
    return distance


def costs() -> dict[str, tuple[str, float]]:
    """What was wrong -> the kind of mistake and what it does to the distance, m."""
    true = _SPEED**2 / (2.0 * _FRICTION * _G)
    wrong = {
        "step of 0.1 ms": ("step", stop(1e-4)),
        "step of 1 ms": ("step", stop(1e-3)),
        "step of 10 ms": ("step", stop(1e-2)),
        "speed sensor 1 % off": ("sensor", stop(speed=1.01 * _SPEED)),
        "floor tilted by 1°": ("surroundings", stop(slope=math.radians(1.0))),
        "friction 10 % too high": ("model", stop(friction=1.1 * _FRICTION)),
        "brake delay of 50 ms left out": ("model", stop(delay=0.05)),
    }
    return {name: (kind, abs(found - true)) for name, (kind, found) in wrong.items()}


def budget() -> Figure:
    """The costs as dots on a logarithmic axis, numerical ones apart from those of the model."""
    looks = {
        "step": (PALETTE["blue"], "o"),
        "sensor": (PALETTE["green"], "s"),
        "surroundings": (PALETTE["orange"], "^"),
        "model": (PALETTE["vermillion"], "D"),
    }
    figure, (axes,) = new_figure(3.3)
    figure.subplots_adjust(left=0.32)
    found = costs()
    for row, (kind, cost) in enumerate(found.values()):
        color, marker = looks[kind]
        axes.plot([0.05, 1000 * cost], [row, row], color=color, linewidth=1.2)
        axes.plot(1000 * cost, row, color=color, marker=marker, markersize=7)
        shown = f"{1000 * cost:.1f}" if cost < 0.0095 else f"{1000 * cost:.0f}"
        axes.text(1000 * cost * 1.25, row, shown, va="center", fontsize=8.5)
    axes.set_yticks(np.arange(len(found)), list(found))
    axes.set(xscale="log", xlim=(0.05, 320), ylim=(-0.6, len(found) - 0.4))
    axes.set_xticks([0.1, 1.0, 10.0, 100.0], ["0.1", "1", "10", "100"])
    axes.set_xlabel("error of the stopping distance (mm of 408)")
    title(figure, "A wrong friction or a forgotten delay costs more than a coarse step")
    return figure
