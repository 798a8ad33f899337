"""Figure of the lesson on the gap between simulation and reality: one gain, chosen in four worlds."""

import math
from functools import cache

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import ArrayLike

from course.figures.style import INK, PALETTE, Array, new_figure, note, ring, title, word
from course.physics.solver import Chain
from course.simulations.experiments.dynamics import from_hanging, swing

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
    best = {world: float(GAINS[np.argmin(_mean_time(world))]) for world in WORLDS}
    return best | {"real": float(GAINS[np.argmin(settles(GAINS, *REAL)[:, 0])])}


def settling() -> Figure:
    """Settling time over gain: in a perfect simulation, in randomised ones and on the real joint."""
    figure, (axes,) = new_figure(4.2)
    looks = {"perfect": ("vermillion", ":"), "wide": ("purple", "-."), "matched": ("blue", "--")}
    real = settles(GAINS, *REAL)[:, 0]
    axes.plot(GAINS, real, color=PALETTE["black"], linewidth=2.0)
    for world, (color, line) in looks.items():
        axes.plot(GAINS, _mean_time(world), color=PALETTE[color], linestyle=line)
    for world, gain in chosen_gains().items():
        if world != "real":
            on_real = float(real[np.flatnonzero(gain == GAINS)[0]])
            ring(axes, gain, on_real, looks[world][0], markeredgewidth=2)
    axes.text(13.3, 0.36, "perfect simulation", color=INK["vermillion"], fontweight="bold")
    axes.text(5.4, 2.42, "randomised far too wide", color=INK["purple"], fontweight="bold")
    axes.text(6.2, 1.32, "randomised\nas measured", color=INK["blue"], fontweight="bold")
    note(axes, "the real joint", (14.5, 1.33), (15.8, 0.95))
    axes.set(xlim=(0, 20.6), ylim=(0, 3.15), xticks=range(0, 21, 5))
    axes.text(6.1, 0.06, "circles: the gain each world prefers, on the real joint", fontsize=8.5)
    axes.set(xlabel="gain (1/s)", ylabel="time to settle (s); the run ends at 3")
    return title(figure, "What is best in a perfect simulation is worst on the real joint")


# ---
# Figures of the lesson on digital twins: a cart whose wheels begin to rub, and the copies that follow it.


_TWIN_H = 0.05  # s
_TWIN_STEPS = 1200
_NEW, _WORN = 0.5, 0.8  # friction per kilogram, 1/s
#: When the wheels begin to rub, s.
WEAR_AT = 20.0
_LOOK_EVERY = 2  # steps between two measured positions
_NOISE = 0.01  # of a measured position, m
_TRUST = 0.3  # share of a surprise that corrects the position (and, per second, the speed)
_LEARN = 0.15  # how fast a surprise corrects the friction


def _moved(place: float, speed: float, friction: float, drive: float) -> tuple[float, float]:
    speed += _TWIN_H * (drive - friction * speed)
    return place + _TWIN_H * speed, speed


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
    for i in range(_TWIN_STEPS):
        cart = _moved(*cart, _NEW if i * _TWIN_H < WEAR_AT else _WORN, drive)
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
    t = _TWIN_H * np.arange(1, _TWIN_STEPS + 1)
    figure, (upper, lower) = new_figure(5.6, 2, 1, sharex=True, hspace=0.26)
    looks = (
        ("model", "vermillion", ":", "never corrected: digital model", (26, 0.62)),
        ("state", "blue", "--", "position corrected: digital shadow", (23, 0.075)),
        ("learning", "green", "-", "friction corrected too", (27, 0.0011)),
    )
    window = np.ones(20) / 20  # a second, so that the noise of single measurements does not fill the panel
    for name, color, line, words, place in looks:
        size = np.sqrt(np.convolve(run[name] ** 2, window, "valid"))
        upper.plot(t[19:], size, color=PALETTE[color], linestyle=line)
        word(upper, *place, words, color)
    upper.set(yscale="log", ylim=(8e-4, 40), ylabel="off by (m, mean of 1 s)")
    upper.set_title("Where is the cart?")
    lower.plot(t, speeds["fixed"], color=PALETTE["purple"], linestyle="-.")
    lower.plot(t, speeds["twin"], color=PALETTE["green"])
    word(lower, 36, 0.66, "drive as planned", "purple")
    word(lower, 36, 1.025, "drive set by the twin", "green")
    lower.set(xlim=(0, 60), ylim=(0.55, 1.12), xlabel="time (s)", ylabel="speed (m/s)")
    lower.set_title("How fast does it go?")
    for axes in (upper, lower):
        axes.axvline(WEAR_AT, color=PALETTE["black"], linewidth=0.8)
    note(lower, "the wheels start to rub", (WEAR_AT, 0.8), (3, 0.65))
    return title(figure, "Measurements keep a copy close; commands restore the robot's speed")


# ---
# Figures of the lesson on accuracy: a step that is too small, how to spend work, paths and statistics.


#: What the figures show and the lesson quotes: rad between two pendulums, and how many make a crowd.
NUDGE, STARTS = 1e-9, 400
#: Angles of both rods from hanging, degrees, and how far apart a crowd starts, rad.
_LET_GO, _SPREAD = (160.0, -95.0), 1e-3


def fall_error(step: float, kind: type[np.floating], g: float = 9.81) -> float:
    """Error of semi-implicit Euler after a fall of 2 s, in m, with numbers of this precision."""
    n = round(2.0 / step)
    h = kind(step)
    v = np.cumsum(np.full(n, -h * kind(g), dtype=kind), dtype=kind)  # adds one by one, as a loop does
    z = np.cumsum(h * v, dtype=kind)
    return abs(float(z[-1]) + 0.5 * g * 2.0**2)


@cache
def _typical_error(step: float, kind: type[np.floating]) -> float:
    """Root mean square of the error over 25 gravities: at a single one, roundings may cancel by luck."""
    return float(np.sqrt(np.mean([fall_error(step, kind, g) ** 2 for g in np.linspace(9.6, 10.0, 25)])))


def small_steps() -> Figure:
    """Error of a fall over the step, in single and in double precision."""
    figure, (axes,) = new_figure(3.9)
    steps = 2.0 ** -np.arange(3, 19)
    for kind, line, marker, color in ((np.float64, "-", "s", "blue"), (np.float32, "--", "o", "vermillion")):
        errors = [_typical_error(float(h), kind) for h in steps]
        axes.plot(steps, errors, color=PALETTE[color], linestyle=line, marker=marker)
    word(axes, 1.3e-4, 3.5e-4, "double precision", "blue")
    word(axes, 4.4e-6, 3.2e-1, "single precision", "vermillion")
    best = float(min(steps, key=lambda h: _typical_error(float(h), np.float32)))
    lowest = (best, _typical_error(best, np.float32))
    note(axes, "best step in\nsingle precision", lowest, (2.2e-4, 3e-2))
    axes.set(xscale="log", yscale="log", xlim=(3e-6, 0.2), ylim=(2e-5, 3))
    axes.set(xlabel="step h (s)", ylabel="error of the height after 2 s (m)")
    return title(figure, "In single precision a step can be too small: rounding takes over")


def substeps() -> Figure:
    """Greatest stretch of a chain for five ways to spend sixteen sweeps a frame over 2 s."""
    figure, (axes,) = new_figure(3.4)
    splits = [(1, 16), (2, 8), (4, 4), (8, 2), (16, 1)]
    stretches = [100 * float(np.max(Chain().stretch(2.0, 1 / 60, *split))) for split in splits]
    places = range(len(splits))
    axes.bar(places, stretches, color=PALETTE["sky"], edgecolor=PALETTE["blue"])
    for x, stretch in zip(places, stretches, strict=True):
        word(axes, x, stretch + 0.15, f"{stretch:.1f} %", ha="center")
    axes.set_xticks(places, [f"{s} × {i}" for s, i in splits])
    axes.set(ylim=(0, 9.6))
    axes.grid(visible=False, axis="x")
    axes.set(xlabel="substeps × iterations (number each frame)", ylabel="greatest stretch of a link (%)")
    return title(figure, "For the same work, many small steps beat many iterations")


@cache
def _crowd(step: float) -> tuple[float, ...]:
    """Share of time (%) that the lower rods of a crowd point in each of 18 directions, from 8 s to 15 s.

    By then the paths of different steps have parted; those of different machines, by rounding, have not yet.
    """
    start = np.radians(_LET_GO) + _SPREAD * np.random.default_rng(1).standard_normal((STARTS, 2))
    t, joints, _ = swing(start, step, round(15.0 / step))
    lower = (from_hanging(joints)[t >= 8.0, :, 1] + math.pi) % (2 * math.pi) - math.pi
    counts, _ = np.histogram(lower, bins=18, range=(-math.pi, math.pi))
    return tuple(100 * counts / lower.size)


def chaos() -> Figure:
    """Two paths a billionth apart, and the statistics of two crowds integrated with different steps."""
    figure, (left, right) = new_figure(3.7, 1, 2, wspace=0.26)
    pair = np.radians(_LET_GO) + np.array([[0.0, 0.0], [NUDGE, 0.0]])
    t, joints, _ = swing(pair, 0.005, 3000)
    angles = from_hanging(joints)
    apart = np.max(np.abs(angles[:, 1] - angles[:, 0]), axis=-1)
    left.plot(t[1:], apart[1:], color=PALETTE["blue"], linewidth=1.2)
    for level, text, place in ((1e-3, "a thousandth", (0.4, 3e-2)), (1.0, "1 rad", (4.2, 2.0e1))):
        when = float(t[np.argmax(apart > level)])
        left.plot([when], [level], marker="o", color=PALETTE["black"])
        note(left, f"{text}\nat {when:.1f} s", (when, level), place)
    left.set(yscale="log", xlim=(0, 15), ylim=(1e-10, 1e3))
    left.set(xlabel="time (s)", ylabel="difference of the angles (rad)", title="Two paths drift apart")
    edges = np.linspace(-180, 180, 19)
    right.stairs(_crowd(0.02), edges, color=PALETTE["vermillion"], linewidth=2.6)
    right.stairs(_crowd(0.01), edges, color=PALETTE["black"], linewidth=1.2, linestyle="--")
    word(right, -170, 9.4, f"{STARTS} starts, step 0.02 s", "vermillion")
    right.text(-170, 8.7, "the same, step 0.01 s (dashed)", fontsize=8.5)
    right.set(xlim=(-180, 180), ylim=(0, 10.4), xticks=(-90, 0, 90))
    right.set_title("Two crowds: equal statistics")
    right.set(xlabel="lower rod from hanging (degrees)", ylabel="share of the time (%)")
    return title(figure, "In chaos no path can be checked, but statistics can be")
