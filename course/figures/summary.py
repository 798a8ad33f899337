"""Figure of the summary: the same six mistakes in two questions about one robot."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from course.figures.drawing.style import PALETTE, new_figure, title

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["MISTAKES", "bounce", "budgets", "stop", "two_questions"]

_G = 9.81
_FINE = 1e-5  # s; small enough that its own error does not count
_LOOKS = {
    "numerical": (PALETTE["blue"], "o"),
    "sensor": (PALETTE["green"], "s"),
    "environment": (PALETTE["orange"], "^"),
    "model": (PALETTE["vermillion"], "D"),
}

#: What is wrong -> which kind of mistake it is.
MISTAKES = {
    "step of 1 ms": "numerical",
    "step of 10 ms": "numerical",
    "speed sensor 1 % off": "sensor",
    "floor tilted by 1°": "environment",
    "friction 10 % too high": "model",
    "delay of 50 ms left out": "model",
}


def stop(
    h: float, *, speed: float = 2.0, friction: float = 0.5, tilt: float = 0.0, delay: float = 0.0
) -> float:
    """Distance that a braking robot slides, m, by semi-implicit Euler.

    Args:
        h: step, s.
        speed: at which it is told to brake, m/s.
        friction: Coulomb's coefficient of the floor.
        tilt: of the floor, downhill, rad.
        delay: between the command and the brake, s.
    """
    distance = speed * delay
    while speed > 0.0:
        speed = max(speed - h * _G * (friction * math.cos(tilt) - math.sin(tilt)), 0.0)
        distance += h * speed
    return distance


def bounce(h: float, *, speed: float = 3.0, tilt: float = 0.0, stiffness: float = 1e5) -> float:
    """Height that a foot of 1 kg rebounds to, m, by semi-implicit Euler; its contact is a stiff spring.

    Args:
        h: step, s.
        speed: at which it lands, m/s.
        tilt: of the floor, rad; turns the rebound by twice as much.
        stiffness: of the contact, N/m.
    """
    depth, velocity = 0.0, -speed
    while depth < 0.0 or velocity < 0.0:
        velocity -= h * (_G + stiffness * min(depth, 0.0))
        depth += h * velocity
    return (velocity * math.cos(2.0 * tilt)) ** 2 / (2.0 * _G)


def budgets() -> dict[str, dict[str, float]]:
    """Question -> mistake -> how far the answer is off, as a share of it."""
    far, high = 2.0**2 / (2 * 0.5 * _G), 3.0**2 / (2 * _G)
    distances = [
        stop(1e-3),
        stop(1e-2),
        stop(_FINE, speed=2.0 * 1.01),
        stop(_FINE, tilt=math.radians(1.0)),
        stop(_FINE, friction=0.5 * 1.1),
        stop(_FINE, delay=0.05),
    ]
    # Neither the floor's friction nor a late brake matters in a bounce: two answers are right as they are.
    heights = [
        bounce(1e-3),
        bounce(1e-2),
        bounce(_FINE, speed=3.0 * 1.01),
        bounce(_FINE, tilt=math.radians(1.0)),
        high,
        high,
    ]
    return {
        "Where does it stop?": dict(zip(MISTAKES, [abs(x / far - 1.0) for x in distances], strict=True)),
        "How high does it bounce?": dict(zip(MISTAKES, [abs(x / high - 1.0) for x in heights], strict=True)),
    }


def two_questions() -> Figure:
    """Both budgets, side by side, on one logarithmic axis."""
    figure, panels = new_figure(3.4, 1, 2, sharey=True)
    figure.subplots_adjust(left=0.27, wspace=0.1)
    for axes, (question, found) in zip(panels, budgets().items(), strict=True):
        for row, (name, share) in enumerate(found.items()):
            _dot(axes, row, 100.0 * share, *_LOOKS[MISTAKES[name]])
        axes.set_title(question)
        axes.set(xscale="log", xlim=(0.03, 4e5), ylim=(-0.6, len(MISTAKES) - 0.4))
        axes.set_xticks([0.1, 1, 10, 100, 1000, 10_000], ["0.1", "1", "10", "100", "1000", ""])
        axes.set_xlabel("error of the answer (%)")
    panels[0].set_yticks(np.arange(len(MISTAKES)), list(MISTAKES))
    title(figure, "Which of the same mistakes matters depends on the question")
    return figure


def _dot(axes: Axes, row: int, percent: float, color: str, marker: str) -> None:
    if percent == 0.0:
        axes.text(0.045, row, "no effect", va="center", fontsize=8.5)
        return
    axes.plot([0.03, percent], [row, row], color=color, linewidth=1.2)
    axes.plot(percent, row, color=color, marker=marker, markersize=7)
    shown = f"{percent:.2f}" if percent < 0.95 else f"{percent:.1f}" if percent < 9.5 else f"{percent:.0f}"
    axes.text(percent * 1.9, row, shown, va="center", fontsize=8.5)
