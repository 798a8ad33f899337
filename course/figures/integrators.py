"""Figures of the lesson on numerical integration: one spring, four methods.

Everything is drawn in the spring's own measure z = h omega, step times angular frequency, so that the
figures hold for every spring.
"""

import math
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from course.figures.style import METHODS, PALETTE, Array, new_figure, note, ring, title
from course.physics.integrators import STEPPERS, State, Trajectory, trajectory
from course.physics.invariants import energy, jacobian, relative_change, spectral_radius
from course.physics.systems import Oscillator

#: What the figures show and their captions quote.
PHASE_Z, PHASE_STEPS = 0.85, 120
ENERGY_Z, ENERGY_STEPS = 0.5, 3000

_OMEGA = 2.0  # rad/s
_SPRING = Oscillator(omega=_OMEGA)
_START = State.at_rest([1.0])


def _spring_path(method: str, z: float, n: int) -> Trajectory:
    return trajectory(STEPPERS[method], _SPRING, _START, z / _OMEGA, n)


def phase_portraits() -> Figure:
    """Velocity over position for each method at z = 0.85: spiral out, two closed curves, spiral in."""
    z, n = PHASE_Z, PHASE_STEPS
    verdicts = {
        "explicit_euler": "Explicit Euler spirals out",
        "semi_implicit_euler": "Semi-implicit Euler: a tilted ellipse",
        "velocity_verlet": "Velocity Verlet: an upright ellipse",
        "rk4": "Runge-Kutta 4 spirals in",
    }
    figure, grid = new_figure(6.8, 2, 2, sharex=True, sharey=True)
    angle = np.linspace(0.0, 2.0 * math.pi, 200)
    for index, (axes, (method, verdict)) in enumerate(zip(grid, verdicts.items(), strict=True)):
        look = METHODS[method]
        path = _spring_path(method, z, n)
        q, p = path.q[:, 0], path.v[:, 0] / _OMEGA
        axes.plot(np.cos(angle), np.sin(angle), color=PALETTE["black"], linewidth=1.0)
        leaves = method == "explicit_euler"
        # 120 steps of explicit Euler leave any paper; a few show where it goes.
        shown = slice(0, 6 if leaves else None)
        line = "-" if leaves else "none"
        axes.plot(
            q[shown], p[shown], color=look.color, linestyle=line, linewidth=0.8,
            marker=look.marker, markersize=3,
        )  # fmt: skip
        ring(axes, q[0], p[0])
        axes.set_title(verdict)
        axes.set(xlim=(-2.2, 2.2), ylim=(-2.2, 2.2), aspect="equal", xticks=range(-2, 3), yticks=range(-2, 3))
        if index % 2 == 0:
            axes.set_ylabel("velocity / ω (m)")
        if index >= 2:
            axes.set_xlabel("position (m)")
        if method == "rk4":
            note(axes, f"step {n}", (q[-1], p[-1]), (-0.55, -0.1), look.ink)
    note(grid[0], "start", (1.0, 0.0), (1.4, 0.75))
    note(grid[0], "exact", (-0.70, 0.71), (-1.7, 1.5))
    return title(figure, "Two methods keep a spring on a closed curve; two do not")


def _worst(method: str, n: int = ENERGY_STEPS) -> Array:
    """The largest relative energy error of the first 1, 2, ... n steps."""
    path = _spring_path(method, ENERGY_Z, n)
    return np.maximum.accumulate(np.abs(relative_change(energy(_SPRING, path.q, path.v))))[1:]


def crossing() -> int:
    """After how many steps RK4's energy error is larger than any of Verlet's."""
    return int(np.argmax(_worst("rk4") > ENERGY_Z**2 / 4)) + 1


def energy_error() -> Figure:
    """Largest relative energy error so far over the number of steps, both axes logarithmic."""
    figure, (axes,) = new_figure(4.0)
    labels = {
        "explicit_euler": (2.0, 1.2e1),
        "semi_implicit_euler": (150, 5.5e-1),
        "velocity_verlet": (2.2, 1.05e-1),
        "rk4": (14, 1.2e-3),
    }
    steps = np.arange(1, ENERGY_STEPS + 1)
    for method, place in labels.items():
        look = METHODS[method]
        worst = _worst(method, 60) if method == "explicit_euler" else _worst(method)
        axes.plot(steps[: worst.size], worst, color=look.color, linestyle=look.line)
        axes.text(*place, look.name, color=look.ink, fontweight="bold")
    met, highest = crossing(), ENERGY_Z**2 / 4
    ring(axes, met, highest)
    told = f"after {met} steps (about 18/z⁴)\nVerlet has the smaller error"
    note(axes, told, (met, highest), (met * 0.75, 6e-3))
    axes.set(xscale="log", yscale="log", xlim=(1, ENERGY_STEPS), ylim=(1e-4, 1e2))
    axes.set(
        xlabel=f"steps taken (step × ω = {ENERGY_Z:g})", ylabel="largest energy error so far (share of E₀)"
    )
    return title(figure, "Verlet's energy error stops growing; that of Runge-Kutta never does")


def error_against_step() -> Figure:
    """Error of the whole state at 5 s over the step, with the slope each method's order promises."""
    figure, (axes,) = new_figure(4.8)
    labels = {
        "explicit_euler": (1.5e-4, 3e-2, "slope 1"),
        "semi_implicit_euler": (1.15e-4, 8e-5, "slope 1"),
        "velocity_verlet": (1.15e-4, 1.5e-7, "slope 2"),
        "rk4": (1.15e-2, 1.5e-10, "slope 4"),
    }
    for method, (x, y, slope) in labels.items():
        look = METHODS[method]
        doublings = 12 if method == "rk4" else 9
        hs, errors = _errors_at_end(method, 20 * 2 ** np.arange(doublings))
        axes.plot(hs, errors, color=look.color, linestyle=look.line, marker=look.marker)
        axes.text(x, y, f"{look.name}: {slope}", color=look.ink, fontweight="bold")
    note(axes, "round-off: from here\nsmaller steps do not help", (2.44e-4, 5e-15), (7e-4, 1e-15))
    axes.set(xscale="log", yscale="log", xlim=(1e-4, 0.4), ylim=(3e-16, 2e2))
    axes.set(xlabel="step h (s), for ω = 2 rad/s", ylabel="error of position and velocity at t = 5 s (m)")
    return title(figure, "Halve the step and the error falls 2, 2, 4 or 16 times, down to round-off")


def _errors_at_end(method: str, counts: NDArray[np.int_]) -> tuple[Array, Array]:
    """Steps (s) and the distance from the exact (q, v / omega) after 5 s (m) for each number of steps.

    All steps advance together, one spring for each: the methods work element by element, so ``h`` may be an
    array. A spring is read when its own number of steps is done.
    """
    t_end = 5.0
    hs = t_end / counts
    state = State.at_rest(np.ones(counts.size))
    step: Any = hs
    errors = np.empty(counts.size)
    done = {int(count): k for k, count in enumerate(counts)}
    for i in range(1, max(done) + 1):
        state = STEPPERS[method].advance(_SPRING, state, step)
        if (k := done.get(i)) is not None:
            dq = state.q[k] - math.cos(_OMEGA * t_end)
            dv = state.v[k] / _OMEGA + math.sin(_OMEGA * t_end)
            errors[k] = math.hypot(dq, dv)
    return hs, errors


def stability() -> Figure:
    """Growth per step (spectral radius of the one-step map) over z, with each method's limit marked."""
    figure, (axes,) = new_figure(3.9)
    zs = np.linspace(0.02, 3.2, 160)
    for method in ("velocity_verlet", "semi_implicit_euler", "rk4", "explicit_euler"):
        look = METHODS[method]
        growth = [_growth(method, float(z)) for z in zs]
        width = 3.2 if method == "velocity_verlet" else 1.6  # the dashes of its twin lie on top of it
        axes.plot(zs, growth, color=look.color, linestyle=look.line, linewidth=width)
    axes.axhline(1.0, color=PALETTE["black"], linewidth=0.8)
    axes.axhspan(1.0, 2.2, color=PALETTE["vermillion"], alpha=0.06, linewidth=0)
    _name_limits(axes)
    axes.set(xlim=(0, 3.2), ylim=(0.4, 2.2))
    axes.set(xlabel="step × ω (z, no unit)", ylabel="growth of the swing per step (factor)")
    return title(figure, "Past its limit a method blows up; explicit Euler has no safe step")


def _growth(method: str, z: float) -> float:
    """Spectral radius of one step on (q, v / omega)."""

    def one_step(y: Array) -> Array:
        state = State.of(y[:1], _OMEGA * y[1:])
        after = STEPPERS[method].advance(_SPRING, state, z / _OMEGA)
        return np.concatenate([after.q, after.v / _OMEGA])

    return spectral_radius(jacobian(one_step, [0.0, 0.0], delta=1.0))


def _name_limits(axes: Axes) -> None:
    black = PALETTE["black"]
    explicit, verlet, rk4 = METHODS["explicit_euler"], METHODS["velocity_verlet"], METHODS["rk4"]
    axes.text(0.28, 1.42, explicit.name, color=explicit.ink, fontweight="bold")
    axes.text(1.02, 0.66, rk4.name, color=rk4.ink, fontweight="bold")
    both = f"{METHODS['semi_implicit_euler'].name}\nand {verlet.name}:\nlimit 2"
    note(axes, both, (2.0, 1.0), (2.2, 1.68), verlet.ink)
    note(axes, "limit 2√2 = 2.83", (2.0 * math.sqrt(2.0), 1.0), (2.32, 1.22), rk4.ink)
    axes.text(0.05, 2.09, "above 1: the swing grows without limit", color=black, fontsize=8.5)
    axes.text(0.05, 0.44, "below 1: the swing dies away", color=black, fontsize=8.5)
