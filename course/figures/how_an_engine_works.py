"""Figure of the lesson on how an engine works: a free body that turns over, and three ways to follow it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from course.figures.drawing.style import METHODS, PALETTE, new_figure, note, title
from course.physics.rotation import ROTATION_STEPPERS, Spin, kinetic_energy

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

__all__ = ["DURATION_S", "INERTIA", "SPIN", "STEP_S", "free_spin", "turning_over"]

#: What the figure shows and the lesson quotes: kg m², rad/s in the body's axes, s.
INERTIA = (1.0, 2.0, 3.0)
SPIN = (0.01, 5.0, 0.01)
STEP_S, DURATION_S = 0.01, 20.0


def free_spin(method: str) -> tuple[Array, Array, Array]:
    """Times (n + 1,), angular velocities (n + 1, 3) and quaternion lengths (n + 1,) of a free body."""
    n = round(DURATION_S / STEP_S)
    t = np.linspace(0.0, n * STEP_S, n + 1)
    inertia, no_torque = np.array(INERTIA), np.zeros(3)
    spin = Spin(np.array([1.0, 0.0, 0.0, 0.0]), np.array(SPIN))
    spins, lengths = [spin.angular_velocity], [1.0]
    for _ in range(n):
        spin = ROTATION_STEPPERS[method].advance(inertia, spin, no_torque, STEP_S)
        spins.append(spin.angular_velocity)
        lengths.append(float(np.linalg.norm(spin.orientation)))
    return t, np.array(spins), np.array(lengths)


def turning_over() -> Figure:
    """Angular velocity about the three axes, and the energy by three methods."""
    figure, (above, below) = new_figure(5.0, 2, 1, sharex=True)
    figure.subplots_adjust(hspace=0.26)
    t, w, _ = free_spin("split")
    # The second axis tells the story; the other two only lend it their energy.
    looks = ((PALETTE["sky"], ":", 1.4), (PALETTE["blue"], "-", 2.0), (PALETTE["purple"], "--", 1.2))
    for k, (color, line, width) in enumerate(looks):
        above.plot(t, w[:, k], color=color, linestyle=line, linewidth=width)
    above.axhline(0.0, color=PALETTE["black"], linewidth=0.8)
    above.set_title("No torque, and yet the body flips over")
    above.set_ylabel("angular velocity (rad/s)")
    above.set(xlim=(0, DURATION_S), ylim=(-7.4, 7.4))
    above.text(0.25, 5.7, "about the middle axis", color=PALETTE["blue"], fontweight="bold", fontsize=8.5)
    flip = int(np.flatnonzero(np.diff(np.sign(w[:, 1])))[0])
    note(above, "flips over", (float(t[flip]), 0.0), (4.0, 2.9), PALETTE["black"])
    late = flip + 35
    note(above, "the other two", (float(t[late]), w[late, 0]), (4.0, -2.9), PALETTE["black"])
    for method in ("explicit_euler", "rk4", "split"):
        _, spins, _ = free_spin(method)
        gained = 100 * (kinetic_energy(INERTIA, spins) / kinetic_energy(INERTIA, spins[0]) - 1)
        look = METHODS.get(method, METHODS["velocity_verlet"])
        below.plot(t, gained, color=look.color, linestyle=look.line)
        if method == "explicit_euler":
            below.text(9.2, 15.5, look.name, color=look.ink, fontweight="bold", ha="right")
            below.text(19.8, gained[-1] + 1.5, f"+{gained[-1]:.0f} %", color=look.ink, ha="right")
    below.text(
        19.8, 1.6, "Runge-Kutta 4 and split rotations", color=METHODS["velocity_verlet"].ink,
        fontweight="bold", ha="right",
    )  # fmt: skip
    below.set_title("Only explicit Euler adds energy")
    below.set(ylim=(-3, 34), xticks=range(0, 21, 5))
    below.set_ylabel("energy gained (%)")
    below.set_xlabel("time (s)")
    title(figure, "A free body flips over by itself, and explicit Euler adds energy each time")
    return figure
