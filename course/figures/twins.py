"""Figures of the lesson on digital twins: a cart whose wheels begin to rub, and the copies that follow it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from course.figures.drawing.style import PALETTE, new_figure, note, title

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

__all__ = ["WEAR_AT", "driven", "followed", "following"]

_H = 0.05  # s
_STEPS = 1200
_NEW, _WORN = 0.5, 0.8  # friction per kilogram, 1/s
#: When the wheels begin to rub, s.
WEAR_AT = 20.0
_LOOK_EVERY = 2  # steps between two measured positions
_NOISE = 0.01  # of a measured position, m
_TRUST = 0.3  # share of a surprise that corrects the position (and, per second, the speed)
_LEARN = 0.15  # how fast a surprise corrects the friction


def _moved(place: float, speed: float, friction: float, drive: float) -> tuple[float, float]:
    speed += _H * (drive - friction * speed)
    return place + _H * speed, speed


def followed(*, seed: int = 1, command: bool = False) -> dict[str, Array]:
    """A cart that is driven for a minute, and three copies of it.

    Args:
        seed: of the noise of the measured positions.
        command: whether the copy that learns the friction also sets the drive, to hold 1 m/s.

    Returns:
        ``model``, ``state`` and ``learning``: how far each copy is ahead of the cart, m; ``friction``: what
        the learning copy believes, 1/s; ``speed``: of the cart, m/s; each of shape (1200,).
    """
    rng = np.random.default_rng(seed)
    cart = model = state = learning = (0.0, 1.0)
    friction = drive = _NEW
    rows = []
    for i in range(_STEPS):
        cart = _moved(*cart, _NEW if i * _H < WEAR_AT else _WORN, drive)
        model, state = _moved(*model, _NEW, drive), _moved(*state, _NEW, drive)
        learning = _moved(*learning, friction, drive)
        if i % _LOOK_EVERY == 0:
            seen = cart[0] + _NOISE * rng.standard_normal()
            surprise = seen - state[0]
            state = state[0] + _TRUST * surprise, state[1] + _TRUST * surprise
            surprise = seen - learning[0]
            learning = learning[0] + _TRUST * surprise, learning[1] + _TRUST * surprise
            friction -= _LEARN * surprise
        drive = friction if command else _NEW
        rows.append((model[0] - cart[0], state[0] - cart[0], learning[0] - cart[0], friction, cart[1]))
    names = ("model", "state", "learning", "friction", "speed")
    return dict(zip(names, np.array(rows).T, strict=True))


def driven() -> dict[str, Array]:
    """Speed of the cart (m/s) with a fixed drive and with the twin's, each of shape (1200,)."""
    return {"fixed": followed()["speed"], "twin": followed(command=True)["speed"]}


def following() -> Figure:
    """How far each copy is off, and how fast the cart goes with and without the twin's command."""
    run, speeds = followed(), driven()
    t = _H * np.arange(1, _STEPS + 1)
    figure, (upper, lower) = new_figure(5.6, 2, 1, sharex=True)
    figure.subplots_adjust(hspace=0.26)
    looks = (
        ("model", PALETTE["vermillion"], ":", "#B34F00", "never corrected: digital model", (26, 0.62)),
        ("state", PALETTE["blue"], "--", "#0072B2", "position corrected: digital shadow", (23, 0.075)),
        ("learning", PALETTE["green"], "-", "#007A58", "friction corrected too", (27, 0.0011)),
    )
    window = np.ones(20) / 20  # a second, so that the noise of single measurements does not fill the panel
    for name, color, line, ink, words, place in looks:
        size = np.sqrt(np.convolve(run[name] ** 2, window, "valid"))
        upper.plot(t[19:], size, color=color, linestyle=line)
        upper.text(*place, words, color=ink, fontweight="bold", fontsize=8.5)
    upper.set(yscale="log", ylim=(8e-4, 40), ylabel="off by (m, mean of 1 s)")
    upper.set_title("Where is the cart?")
    lower.plot(t, speeds["fixed"], color=PALETTE["purple"], linestyle="-.")
    lower.plot(t, speeds["twin"], color=PALETTE["green"])
    lower.text(36, 0.66, "drive as planned", color="#9C4478", fontweight="bold", fontsize=8.5)
    lower.text(36, 1.025, "drive set by the twin", color="#007A58", fontweight="bold", fontsize=8.5)
    lower.set(xlim=(0, 60), ylim=(0.55, 1.12), xlabel="time (s)", ylabel="speed (m/s)")
    lower.set_title("How fast does it go?")
    for axes in (upper, lower):
        axes.axvline(WEAR_AT, color=PALETTE["black"], linewidth=0.8)
    note(lower, "the wheels start to rub", (WEAR_AT, 0.8), (3, 0.65), PALETTE["black"])
    title(figure, "Measurements keep a copy close; commands restore the robot's speed")
    return figure
