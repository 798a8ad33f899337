"""Figure of the lesson on the gap between simulation and reality: one gain, chosen in four worlds."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from course.figures.drawing.style import PALETTE, new_figure, note, title

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from numpy.typing import ArrayLike, NDArray

    Array = NDArray[np.float64]

__all__ = ["GAINS", "REAL", "WORLDS", "chosen_gains", "settling"]

_H, _STEPS = 0.005, 600  # s; 3 s altogether

#: Gains that are tried, 1/s.
GAINS = np.arange(0.5, 20.1, 0.25)
#: The real joint: delay (s) and strength (1 is as commanded).
REAL = (0.08, 0.9)
#: Ranges of delay (s) and strength that a simulated joint is drawn from.
WORLDS = {
    "perfect": ((0.0, 0.0), (1.0, 1.0)),
    "matched": ((0.04, 0.12), (0.8, 1.2)),
    "wide": ((0.0, 0.4), (0.5, 1.5)),
}


def settles(gain: ArrayLike, delay: ArrayLike, strength: ArrayLike) -> Array:
    """Time until a joint that is told to go to 1 rad stays within 2 % of it, s; 3 if it takes longer.

    Args:
        gain: shape (K,), 1/s.
        delay, strength: of the joints, shape (D,); s and 1.

    Returns:
        Shape (K, D).
    """
    gain = np.atleast_1d(np.asarray(gain, dtype=float))[:, None]
    strength = np.atleast_1d(np.asarray(strength, dtype=float))
    late = np.rint(np.atleast_1d(np.asarray(delay, dtype=float)) / _H).astype(int)
    joint = np.arange(late.size)
    angle = np.zeros((_STEPS + 1, gain.size, late.size))
    for i in range(_STEPS):
        seen = angle[np.maximum(i - late, 0), :, joint].T
        angle[i + 1] = angle[i] + _H * strength * gain * (1.0 - seen)
    off = np.abs(1.0 - angle) > 0.02
    return np.asarray(_H * (_STEPS - off[::-1].argmax(axis=0)))


def _mean_time(world: str) -> Array:
    (low, high), (weak, strong) = WORLDS[world]
    rng = np.random.default_rng(2)
    count = 1 if low == high else 200
    delay, strength = rng.uniform(low, high, count), rng.uniform(weak, strong, count)
    return np.asarray(settles(GAINS, delay, strength).mean(axis=1))


def chosen_gains() -> dict[str, float]:
    """The gain that looks best in each world, 1/s, and the one that is best for the real joint."""
    best = {world: float(GAINS[_mean_time(world).argmin()]) for world in WORLDS}
    return best | {"real": float(GAINS[settles(GAINS, *REAL)[:, 0].argmin()])}


def settling() -> Figure:
    """Settling time over gain: in a perfect simulation, in randomised ones and on the real joint."""
    figure, (axes,) = new_figure(4.2)
    looks = {
        "perfect": (PALETTE["vermillion"], ":", "#B34F00"),
        "wide": (PALETTE["purple"], "-.", "#9C4478"),
        "matched": (PALETTE["blue"], "--", "#0072B2"),
    }
    real = settles(GAINS, *REAL)[:, 0]
    axes.plot(GAINS, real, color=PALETTE["black"], linewidth=2.0)
    for world, (color, line, _) in looks.items():
        axes.plot(GAINS, _mean_time(world), color=color, linestyle=line)
    for world, gain in chosen_gains().items():
        if world != "real":
            on_real = float(real[np.flatnonzero(gain == GAINS)[0]])
            color = looks[world][0]
            axes.plot(
                gain,
                on_real,
                marker="o",
                markersize=9,
                markerfacecolor="none",
                color=color,
                markeredgewidth=2,
            )
    axes.text(13.3, 0.36, "perfect simulation", color="#B34F00", fontweight="bold")
    axes.text(5.4, 2.42, "randomised far too wide", color="#9C4478", fontweight="bold")
    axes.text(6.2, 1.32, "randomised\nas measured", color="#0072B2", fontweight="bold")
    note(axes, "the real joint", (14.5, 1.33), (15.8, 0.95), PALETTE["black"])
    axes.set(xlim=(0, 20.6), ylim=(0, 3.15), xticks=range(0, 21, 5))
    axes.text(6.1, 0.06, "circles: the gain each world prefers, on the real joint", fontsize=8.5)
    axes.set_xlabel("gain (1/s)")
    axes.set_ylabel("time to settle (s); the run ends at 3")
    title(figure, "What is best in a perfect simulation is worst on the real joint")
    return figure
