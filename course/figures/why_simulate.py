"""Figure of the lesson on why to simulate: a standing robot, tried sixteen hundred times at once.

The robot is one stiff body on its ankles, an upside-down pendulum. Its controller pushes back against the
lean with ``kp`` and against the rate of leaning with ``kd``, through an ankle that cannot push harder than
the foot is long, and it acts on the state of some time ago.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.colors import ListedColormap

from course.figures.drawing.style import PALETTE, new_figure, title

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

__all__ = ["DELAY_S", "FALLEN", "STANDING", "SWAYING", "TRIES", "fate", "gains", "standing"]

#: What the figure shows and its caption quotes: tries a side, and the delay of the real robot.
TRIES, DELAY_S = 40, 0.1
FALLEN, SWAYING, STANDING = 0, 1, 2

_MASS, _HEIGHT, _G = 50.0, 0.9, 9.81  # kg, m (centre of mass), m/s²
_MOST = 60.0  # N m: more would lift the toes or the heel
_PUSH = 0.3  # rad/s, what the robot has to cope with
_STEP, _DURATION = 0.005, 5.0  # s


def gains() -> tuple[Array, Array]:
    """The settings tried: kp (N m/rad) and kd (N m s/rad), each of shape (TRIES, TRIES)."""
    kp, kd = np.meshgrid(np.linspace(75, 3000, TRIES), np.linspace(25, 1000, TRIES))
    return kp, kd


def fate(kp: Array, kd: Array, delay: float) -> NDArray[np.int_]:
    """How a robot ends with each setting after one push: FALLEN, SWAYING or STANDING.

    Args:
        kp, kd: N m/rad and N m s/rad, any shape; all robots are simulated together.
        delay: s, a whole number of steps.
    """
    steps, lag = round(_DURATION / _STEP), round(delay / _STEP)
    lean = np.zeros((steps + 1, *kp.shape))
    rate = np.full_like(lean, _PUSH)
    for i in range(steps):
        seen = max(i - lag, 0)
        torque = np.clip(-kp * lean[seen] - kd * rate[seen], -_MOST, _MOST)
        turn = _G / _HEIGHT * np.sin(lean[i]) + torque / (_MASS * _HEIGHT**2)
        rate[i + 1] = rate[i] + _STEP * turn
        lean[i + 1] = lean[i] + _STEP * rate[i + 1]
    fell = np.max(np.abs(lean), axis=0) > 0.5
    # Upright and still: within 0.01 rad over the whole last second.
    calm = np.max(np.abs(lean[-round(1.0 / _STEP) :]), axis=0) < 0.01
    return np.where(fell, FALLEN, np.where(calm, STANDING, SWAYING))


def standing() -> Figure:
    """Which settings keep the robot on its feet, without delay and with the delay of a real one."""
    figure, axes = new_figure(3.9, 1, 2, sharey=True)
    kp, kd = gains()
    before = fate(kp, kd, 0.0)
    after = fate(kp, kd, DELAY_S)
    _map(axes[0], kp, kd, before, "The simulator leaves out the delay")
    _map(axes[1], kp, kd, after, f"The robot acts {DELAY_S:g} s late")
    _name(axes[0], [(1900, 540, "stands still"), (140, 830, "leans,\nsways"), (70, 130, "falls")])
    _name(
        axes[1],
        [
            (1120, 540, "stands still"),
            (2330, 450, "trembles"),
            (420, 830, "leans,\nsways"),
            (1500, 55, "falls"),
        ],
    )
    axes[0].set_ylabel("reaction to the speed of leaning (N m s/rad)")
    share = np.count_nonzero((before == STANDING) & (after == STANDING)) / np.count_nonzero(
        before == STANDING
    )
    title(figure, f"Of the gains that work in the simulator, {100 * share:.0f} % work on the robot")
    return figure


def _map(axes: Axes, kp: Array, kd: Array, what: NDArray[np.int_], heading: str) -> None:
    colors = ListedColormap(["#F1F1F1", PALETTE["orange"], PALETTE["blue"]])
    axes.pcolormesh(kp, kd, what, cmap=colors, vmin=0, vmax=2, shading="nearest")
    axes.set_title(heading)
    axes.set_xlabel("reaction to the lean (N m/rad)")
    axes.set(xlim=(38, 3038), ylim=(12, 1012), xticks=range(500, 3000, 500))
    axes.grid(visible=False)


def _name(axes: Axes, regions: list[tuple[float, float, str]]) -> None:
    for x, y, text in regions:
        color = "white" if text == "stands still" else PALETTE["black"]
        axes.text(x, y, text, color=color, fontsize=8.5, fontweight="bold")
