"""Figures of the lesson on contact: a pair that passes or parts, a wall that is missed, a stack."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from course.figures.drawing.style import PALETTE, new_figure, note, title
from course.physics.body import Body
from course.physics.contact import Surface
from course.physics.simulator import Simulator
from course.physics.solver import iterations_to, stack_impulses
from course.physics.state import RigidBodyState

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

__all__ = ["BALL_M", "STACKS", "STEP_S", "WALL_M", "head_on", "pair", "passed", "stacks", "tunnelling"]

#: What the figures show and the captions quote: diameter of the ball, thickness of the wall (m), step (s).
BALL_M, WALL_M, STEP_S = 0.02, 0.02, 0.01
STACKS = (2, 5, 10, 20)


def head_on(restitution: float | None) -> tuple[Array, Array]:
    """Times (n + 1,) and positions (n + 1, 2), m, of two balls of radius 0.5 m; None: they pass through."""
    starts = (RigidBodyState.of([x, 0, 0], [v, 0, 0]) for x, v in ((-5.0, 2.0), (5.0, -2.0)))
    bodies = [Body.sphere(1.0, 0.5, start) for start in starts]
    surface = Surface(0.0 if restitution is None else restitution)
    engine = Simulator(
        bodies, h=0.01, gravity=0.0, ground=None, surface=surface, contacts=restitution is not None
    )
    record = engine.run(5.0)
    return record.t, record.position[:, :, 0]


def pair() -> Figure:
    """Two balls head on: without contact they trade places, with it they part at e times their speed."""
    figure, (left, right) = new_figure(3.6, 1, 2, sharex=True, sharey=True)
    t, x = head_on(None)
    _two(left, t, x, "-")
    left.set_title("No contact: they change sides")
    for e, line in ((1.0, "-"), (0.5, "--"), (0.0, ":")):
        t, x = head_on(e)
        _two(right, t, x, line)
        right.text(4.95, x[-1, 1] + 0.25, f"e = {e:g}", ha="right", fontsize=8.5)
    right.set_title("Contact: they touch and part")
    note(left, "through\neach other\nat 2.5 s", (2.5, 0.0), (3.4, -1.0), PALETTE["black"])
    note(right, "touch at\n2.25 s,\n1 m apart", (2.25, -0.5), (0.2, -1.0), PALETTE["black"])
    for axes in (left, right):
        axes.text(0.1, -5.9, "ball 1", color=PALETTE["blue"], fontweight="bold", fontsize=8.5)
        axes.text(0.1, 5.4, "ball 2", color="#B34F00", fontweight="bold", fontsize=8.5)
        axes.set_xlabel("time (s)")
    left.set(xlim=(0, 5), ylim=(-6.8, 6.8))
    left.set_ylabel("position (m)")
    title(figure, "Both pictures end with the balls far apart; only one has a collision in it")
    return figure


def _two(axes: Axes, t: Array, x: Array, line: str) -> None:
    for k, color in enumerate((PALETTE["blue"], PALETTE["vermillion"])):
        axes.plot(t, x[:, k], color=color, linestyle=line)


def passed(speed: float, h: float = STEP_S, tries: int = 500) -> float:
    """Share of starts from which a ball gets past the wall without touching it at any sample."""
    reach = BALL_M + WALL_M  # from first to last touch, as the centre travels
    # The centre enters this stretch somewhere within its first step there.
    first = (np.arange(tries) + 0.5) / tries * speed * h
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
    axes.text(
        1.0, -7.5, "time of impact: never misses", color=PALETTE["blue"], fontweight="bold", fontsize=8.5
    )
    limit = (BALL_M + WALL_M) / STEP_S
    note(axes, f"{limit:g} m/s: one step\nspans wall and ball", (limit, 0.0), (0.6, 32.0), PALETTE["black"])
    axes.set(xlim=(0, 24), ylim=(-12, 100))
    axes.set_xlabel("speed of the ball (m/s)")
    axes.set_ylabel("starts that miss the wall (%)")
    title(figure, "A check once a step misses a wall that the ball jumps over")
    return figure


def stacks() -> Figure:
    """The weight that the ground does not carry yet, over the solver's iterations, for four stacks."""
    figure, (axes,) = new_figure(4.0)
    looks = (
        (PALETTE["sky"], ":"),
        (PALETTE["green"], "-."),
        (PALETTE["orange"], "--"),
        (PALETTE["blue"], "-"),
    )
    for boxes, (color, line) in zip(STACKS, looks, strict=True):
        needed = iterations_to(boxes)
        carried = stack_impulses(boxes, needed + needed // 3)[:, 0] / boxes
        done = np.arange(1, carried.size)
        axes.plot(done, 100 * (1 - carried[1:]), color=color, linestyle=line, linewidth=1.8)
        axes.plot([needed], [1.0], marker="o", color=PALETTE["black"], markersize=5)
        axes.text(needed * 0.93, 0.72, f"{needed}", ha="right", fontsize=8.5, fontweight="bold")
    for boxes, x, y in ((2, 1.7, 5.6), (5, 6.6, 12.0), (10, 21.0, 18.0), (20, 68.0, 27.0)):
        axes.text(x, y, f"{boxes} boxes", fontsize=8.5)
    axes.axhline(1.0, color=PALETTE["black"], linewidth=0.8)
    axes.set(xscale="log", yscale="log", xlim=(1, 1100), ylim=(0.4, 110))
    axes.set_xlabel("iterations of the solver (number)")
    axes.set_ylabel("weight not yet carried by the ground (%)")
    title(figure, "Twice as high takes four times as many iterations")
    return figure
