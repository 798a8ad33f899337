"""Figures of the lesson on contact: a pair that passes or parts, a wall that is missed, a stack."""

import math

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from course.figures.style import METHODS, PALETTE, Array, new_figure, note, title, word
from course.physics.contact.models import Constraint, Penalty, SoftConvex, drop, erp_cfm, slide_across
from course.physics.rotation import ROTATION_STEPPERS, Spin, kinetic_energy, rotate
from course.physics.solver import iterations_to, stack_impulses
from course.simulations.base import run
from course.simulations.experiments.contact import rebounds
from course.simulations.registry import get

#: What the figures show and the captions quote: diameter of the ball, thickness of the wall (m), step (s).
BALL_M, WALL_M, STEP_S = 0.02, 0.02, 0.01
STACKS = (2, 5, 10, 20)


def head_on(restitution: float) -> tuple[Array, Array]:
    """Times (n + 1,) and positions (n + 1, 2), m, of the two balls of the simulation of a collision."""
    result = run(get("collision"), [f"restitution={restitution:g}"])
    return result.column("t"), np.stack([result.column("x1"), result.column("x2")], axis=-1)


def pair() -> Figure:
    """Two balls head on: without contact they trade places, with it they part at e times their speed."""
    figure, (left, right) = new_figure(3.6, 1, 2, sharex=True, sharey=True)
    t, x = head_on(1.0)
    _two(left, t, x[0] + np.array([2.0, -2.0]) * t[:, None], "-")
    left.set_title("No contact: they change sides")
    for e, line in ((1.0, "-"), (0.5, "--"), (0.0, ":")):
        t, x = head_on(e)
        _two(right, t, x, line)
        right.text(4.95, x[-1, 1] + 0.25, f"e = {e:g}", ha="right", fontsize=8.5)
    right.set_title("Contact: they touch and part")
    note(left, "through\neach other\nat 2.5 s", (2.5, 0.0), (3.4, -1.0))
    note(right, "touch at\n2.25 s,\n1 m apart", (2.25, -0.5), (0.2, -1.0))
    for axes in (left, right):
        word(axes, 0.1, -5.9, "ball 1", "blue")
        word(axes, 0.1, 5.4, "ball 2", "vermillion")
        axes.set_xlabel("time (s)")
    left.set(xlim=(0, 5), ylim=(-6.8, 6.8))
    left.set_ylabel("position (m)")
    return title(figure, "Both pictures end with the balls far apart; only one has a collision in it")


def _two(axes: Axes, t: Array, x: Array, line: str) -> None:
    for k, color in enumerate((PALETTE["blue"], PALETTE["vermillion"])):
        axes.plot(t, x[:, k], color=color, linestyle=line)


def passed(speed: float, h: float = STEP_S) -> float:
    """Share of starts from which a ball gets past the wall without touching it at any sample."""
    reach = BALL_M + WALL_M  # from first to last touch, as the centre travels
    # The centre enters this stretch somewhere within its first step there: 500 places are tried.
    first = (np.arange(500) + 0.5) / 500 * speed * h
    return float(np.mean(first > reach))


def tunnelling() -> Figure:
    """How often a wall is missed, over the speed, for three steps."""
    figure, (axes,) = new_figure(3.5)
    speeds = np.linspace(0.05, 24.0, 480)
    for parts, line, color, aside in (
        (1, "-", "vermillion", 4),
        (2, "--", "orange", 4),
        (4, "-.", "sky", -16),
    ):
        h = STEP_S / parts
        share = [100 * passed(float(v), h) for v in speeds]
        axes.plot(speeds, share, color=PALETTE[color], linestyle=line, linewidth=2.0)
        at = 23.6
        axes.text(at, 100 * passed(at, h) + aside, f"h = {1000 * h:g} ms", ha="right", fontsize=8.5)
    axes.axhline(0.0, color=PALETTE["blue"], linewidth=2.4)
    word(axes, 1.0, -7.5, "time of impact: never misses", "blue")
    limit = (BALL_M + WALL_M) / STEP_S
    note(axes, f"{limit:g} m/s: one step\nspans wall and ball", (limit, 0.0), (0.6, 32.0))
    axes.set(xlim=(0, 24), ylim=(-12, 100))
    axes.set(xlabel="speed of the ball (m/s)", ylabel="starts that miss the wall (%)")
    return title(figure, "A check once a step misses a wall that the ball jumps over")


def stacks() -> Figure:
    """The weight that the ground does not carry yet, over the solver's iterations, for four stacks."""
    figure, (axes,) = new_figure(4.0)
    looks = (("sky", ":"), ("green", "-."), ("orange", "--"), ("blue", "-"))
    for boxes, (color, line) in zip(STACKS, looks, strict=True):
        needed = iterations_to(boxes)
        carried = stack_impulses(boxes, needed + needed // 3)[:, 0] / boxes
        done = np.arange(1, carried.size)
        axes.plot(done, 100 * (1 - carried[1:]), color=PALETTE[color], linestyle=line, linewidth=1.8)
        axes.plot([needed], [1.0], marker="o", color=PALETTE["black"], markersize=5)
        word(axes, needed * 0.93, 0.72, f"{needed}", ha="right")
    for boxes, x, y in ((2, 1.7, 5.6), (5, 6.6, 12.0), (10, 21.0, 18.0), (20, 68.0, 27.0)):
        axes.text(x, y, f"{boxes} boxes", fontsize=8.5)
    axes.axhline(1.0, color=PALETTE["black"], linewidth=0.8)
    axes.set(xscale="log", yscale="log", xlim=(1, 1100), ylim=(0.4, 110))
    axes.set(xlabel="iterations of the solver (number)", ylabel="weight not yet carried by the ground (%)")
    return title(figure, "Twice as high takes four times as many iterations")


# ---
# Figures of the lesson on contact models: a ball at rest, a bounce at every phase, friction from above.


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
        word(axes, x, y, name, color)
    axes.set(xlim=(0, 0.4), ylim=(1.85, -0.1), xticks=[0.0, 0.1, 0.2, 0.3, 0.4])
    axes.set(xlabel="time since the ball was laid down (s)", ylabel="depth in the floor (mm)")
    return title(figure, "How deep a resting ball lies depends on the contact model")


def phases() -> Figure:
    """The rebound over the phase of the step: exact, looked at once a step, and with correction."""
    figure, (axes,) = new_figure(3.6)
    for erp, color, line in ((0.0, "blue", "-"), (0.2, "vermillion", "--")):
        values = rebounds(Constraint(0.5, erp=erp), 1.0, PHASES, _STEP_S, _G)
        # The tooth's edge is a jump, so no line is drawn across it.
        broken = np.where(np.abs(np.diff(values, prepend=values[0])) > 0.02, np.nan, values)
        axes.plot(PHASES, broken, color=PALETTE[color], linestyle=line, linewidth=1.8)
    axes.axhline(0.25, color=PALETTE["black"], linewidth=1.2)
    word(axes, 0.99, 0.257, "event-driven: 0.25", ha="right")
    word(axes, 0.99, 0.188, "once a step, no correction", "blue", ha="right")
    word(axes, 0.62, 0.43, "ERP 0.2 in the velocity", "vermillion")
    axes.set(xlim=(-0.01, 1.0), ylim=(0.16, 0.5))
    axes.set(xlabel="start, in parts of a step's fall (no unit)", ylabel="rebound (share of the height)")
    return title(figure, "How high a ball bounces depends on when the engine looks")


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
    axes.set(xlabel="x, an axis of the pyramid (m)", ylabel="y (m)")
    return title(figure, "Along its diagonal a friction pyramid is too strong or too weak")


def corners() -> Figure:
    """Two boxes whose shadows are apart in one direction; a box that the second of two tiles pushes back."""
    figure, (left, right) = new_figure(3.2, 1, 2, wspace=0.28)
    half = 0.5 * np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)])
    slant = np.array([1.0, 1.0]) / math.sqrt(2)
    across = np.array([1.0, -1.0]) / math.sqrt(2)
    turned = half @ np.array([slant, -across]) + 1.05
    for shape, color, name, place in (
        (half, "blue", "a", (-0.05, -0.1)),
        (turned, "vermillion", "b", (1.0, 1.0)),
    ):
        left.fill(*shape.T, facecolor="none", edgecolor=PALETTE[color], linewidth=1.6)
        left.text(*place, name, fontsize=9.5, fontweight="bold")
        low, high = shape.min(axis=0), shape.max(axis=0)
        upright = np.array([low, (high[0], low[1]), high, (low[0], high[1])])
        left.fill(*upright.T, facecolor="none", edgecolor=PALETTE["grey"], linewidth=0.8, linestyle=":")
        shadow = np.array([np.min(shape @ slant), np.max(shape @ slant)])
        ends = shadow[:, None] * slant + 1.25 * across
        left.plot(*ends.T, color=PALETTE[color], linewidth=4.0, solid_capstyle="butt")
    gap = (np.max(half @ slant) + np.min(turned @ slant)) / 2 * slant + 1.25 * across
    note(left, "a gap between\nthe shadows", (float(gap[0]), float(gap[1])), (1.35, -1.45))
    left.set(xlim=(-0.9, 3.0), ylim=(-1.7, 1.9), xticks=range(3), yticks=range(-1, 2), aspect="equal")
    left.set_title("Apart in one direction")
    for tile, x in (("tile 1", -5.0), ("tile 2", 0.0)):
        right.fill([x, x + 5, x + 5, x], [-5, -5, 0, 0], facecolor="#E2E2E2", edgecolor=PALETTE["black"])
        right.text(x + 2.5, -4.4, tile, fontsize=8.5, ha="center")
    right.fill([-9, 1, 1, -9], [-2, -2, 9, 9], facecolor="none", edgecolor=PALETTE["blue"], linewidth=1.6)
    word(right, -4.8, 2.9, "box, moving right", "blue")
    for start, end, text, place in (
        ((-2.5, -2.0), (-2.5, 0.9), "up 2 mm", (-2.2, 0.5)),
        ((1.0, -1.0), (-1.4, -1.0), "back 1 mm", (1.2, -1.2)),
    ):
        arrow = {"arrowstyle": "->", "color": PALETTE["vermillion"], "linewidth": 2.0}
        right.annotate("", xy=end, xytext=start, arrowprops=arrow)
        word(right, *place, text, "vermillion")
    right.set(xlim=(-5.2, 5.2), ylim=(-5.0, 4.5), xticks=range(-4, 5, 2))
    right.set_title("Over a seam")
    for axes, unit in ((left, "m"), (right, "mm")):
        axes.set(xlabel=f"x ({unit})", ylabel=f"y ({unit})")
    return title(figure, "One direction shows that boxes are apart; a seam sends them back")


# ---
# Figure of the lesson on how an engine works: a free body that turns over, and three ways to follow it.


#: What the figure shows and the lesson quotes: kg m², rad/s in the body's axes, s.
INERTIA = (1.0, 2.0, 3.0)
SPIN = (0.01, 5.0, 0.01)
WORLD_STEP_S, DURATION_S = 0.01, 20.0


def free_spin(method: str) -> tuple[Array, Array, Array]:
    """Times (n + 1,), angular velocities (n + 1, 3) and quaternion lengths (n + 1,) of a free body."""
    n = round(DURATION_S / WORLD_STEP_S)
    start = Spin(np.array([1.0, 0.0, 0.0, 0.0]), np.array(SPIN))
    q, w = rotate(ROTATION_STEPPERS[method], np.array(INERTIA), start, WORLD_STEP_S, n)
    return np.linspace(0.0, n * WORLD_STEP_S, n + 1), w, np.linalg.norm(q, axis=-1)


def turning_over() -> Figure:
    """Angular velocity about the three axes, and the energy by three methods."""
    figure, (above, below) = new_figure(5.0, 2, 1, sharex=True, hspace=0.26)
    t, w, _ = free_spin("split")
    # The second axis tells the story; the other two only lend it their energy.
    looks = ((PALETTE["sky"], ":", 1.4), (PALETTE["blue"], "-", 2.0), (PALETTE["purple"], "--", 1.2))
    for k, (color, line, width) in enumerate(looks):
        above.plot(t, w[:, k], color=color, linestyle=line, linewidth=width)
    above.axhline(0.0, color=PALETTE["black"], linewidth=0.8)
    above.set(ylabel="angular velocity (rad/s)", title="No torque, and yet the body flips over")
    above.set(xlim=(0, DURATION_S), ylim=(-7.4, 7.4))
    word(above, 0.25, 5.7, "about the middle axis", "blue")
    flip = int(np.flatnonzero(np.diff(np.sign(w[:, 1])))[0])
    note(above, "flips over", (float(t[flip]), 0.0), (4.0, 2.9))
    late = flip + 35
    note(above, "the other two", (float(t[late]), w[late, 0]), (4.0, -2.9))
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
    below.set(xlabel="time (s)", ylabel="energy gained (%)")
    return title(figure, "A free body flips over by itself, and explicit Euler adds energy each time")
