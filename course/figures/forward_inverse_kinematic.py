"""Figures of the lesson on three kinds of simulation: one arm, planned, driven and let go."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from course.figures.drawing.style import PALETTE, new_figure, note, title
from course.physics.dynamics import HandPath, TwoLinkArm
from course.physics.integrators import RK4, State, trajectory

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from numpy.typing import ArrayLike, NDArray

    Array = NDArray[np.float64]

__all__ = ["END", "LOAD_KG", "START", "driven", "loaded", "path", "planned", "torques"]

#: What the figures show and the lesson quotes: the ends of the hand's path (m) and a forgotten load (kg).
START, END, LOAD_KG = (1.2, -0.8), (0.6, 1.2), 0.1
_STEP = 0.01  # s
_ARM = TwoLinkArm()


def path(duration: float) -> HandPath:
    """The straight path of the hand from START to END, in so many seconds."""
    return HandPath(START, END, duration)


def loaded(mass: float) -> TwoLinkArm:
    """The arm with a point mass (kg) in its hand."""
    whole = _ARM.mass2 + mass
    centre = (_ARM.mass2 * _ARM.centre2 + mass * _ARM.length2) / whole
    spread = _ARM.mass2 * (centre - _ARM.centre2) ** 2 + mass * (_ARM.length2 - centre) ** 2
    return replace(_ARM, mass2=whole, centre2=centre, inertia2=_ARM.inertia2 + spread)


class _Driven:
    """An arm under the torques planned for the bare arm, with or without feedback, to be integrated."""

    def __init__(self, arm: TwoLinkArm, plan: HandPath, stiffness: float, damping: float) -> None:
        self.arm, self.plan, self.stiffness, self.damping = arm, plan, stiffness, damping

    def __call__(self, t: float, q: ArrayLike, v: ArrayLike) -> Array:
        wanted, rate, change = self.plan.joints(_ARM, t)
        correction = self.stiffness * (wanted - np.asarray(q)) + self.damping * (rate - np.asarray(v))
        return self.arm.forward(q, v, _ARM.inverse(wanted, rate, change) + correction)

    def params(self) -> dict[str, Any]:
        return {}


def driven(load: float, *, feedback: bool = False) -> Array:
    """The path of the hand within a second under the planned torques, m, shape (n + 1, 2).

    Args:
        load: kg in the hand that the plan does not know of.
        feedback: add 100 N m/rad and 20 N m s/rad times the errors of the joints.
    """
    plan = path(1.0)
    q, v, _ = plan.joints(_ARM, 0.0)
    arm = loaded(load) if load > 0 else _ARM
    gains = (100.0, 20.0) if feedback else (0.0, 0.0)
    run = trajectory(RK4(), _Driven(arm, plan, *gains), State.of(q, v), _STEP, round(1.0 / _STEP))
    return arm.hand(run.q)


def planned() -> Figure:
    """Kinematics: nine poses of the arm as its hand follows a straight line, and the joint angles."""
    figure, (left, right) = new_figure(3.6, 1, 2)
    figure.subplots_adjust(wspace=0.28)
    plan = path(1.0)
    shares = np.linspace(0.0, 1.0, 9)
    poses, _, _ = plan.joints(_ARM, shares)
    for k, pose in enumerate(poses):
        elbow, hand = _ARM.elbow(pose), _ARM.hand(pose)
        strong = k in (0, len(poses) - 1)
        color = PALETTE["black"] if strong else "#A9A9A9"
        left.plot(
            [0, elbow[0], hand[0]], [0, elbow[1], hand[1]], color=color, linewidth=1.6 if strong else 0.9
        )
        left.plot(*hand, marker="o", color=PALETTE["vermillion"])
    left.plot([START[0], END[0]], [START[1], END[1]], color=PALETTE["vermillion"], linewidth=1.0)
    left.plot(0, 0, marker="s", color=PALETTE["black"], markersize=7)
    left.text(-0.18, 0.14, "shoulder", fontsize=8.5, ha="right")
    left.text(1.28, -0.9, "start", fontsize=8.5)
    left.text(0.52, 1.3, "end", fontsize=8.5)
    left.set(xlim=(-1.0, 2.0), ylim=(-1.5, 1.6), aspect="equal")
    left.set_title("The hand: a straight line")
    left.set_xlabel("x (m)")
    left.set_ylabel("y (m)")
    t = np.linspace(0.0, 1.0, 101)
    q = np.degrees(plan.joints(_ARM, t)[0])
    right.plot(t, q[:, 0], color=PALETTE["blue"])
    right.plot(t, q[:, 1], color=PALETTE["green"], linestyle="--")
    right.text(0.63, -40.0, "shoulder", color=PALETTE["blue"], fontweight="bold", fontsize=8.5)
    right.text(0.05, 99.0, "elbow", color="#007A58", fontweight="bold", fontsize=8.5)
    most = int(np.argmax(q[:, 1]))
    note(right, "bends, then\nstraightens", (float(t[most]), float(q[most, 1])), (0.44, 62), PALETTE["black"])
    right.set(xlim=(0, 1), ylim=(-90, 145), yticks=range(-90, 136, 45))
    right.set_title("The joints: curved paths")
    right.set_xlabel("time (s)")
    right.set_ylabel("joint angle (degrees)")
    title(figure, "On a straight line of the hand the joints turn back and forth")
    return figure


def torques() -> Figure:
    """Inverse and forward: the shoulder's torque at three speeds; where a forgotten load takes the hand."""
    figure, (left, right) = new_figure(3.8, 1, 2)
    figure.subplots_adjust(wspace=0.28)
    share = np.linspace(0.0, 1.0, 201)
    for duration, line, color in ((0.5, "-", "vermillion"), (1.0, "--", "blue"), (2.0, "-.", "green")):
        q, v, a = path(duration).joints(_ARM, share * duration)
        left.plot(share, _ARM.inverse(q, v, a)[:, 0], color=PALETTE[color], linestyle=line)
    left.plot(share, _ARM.inverse(q, 0 * v, 0 * a)[:, 0], color=PALETTE["black"], linewidth=0.9)
    left.text(0.5, 76.0, "in 0.5 s", color="#B34F00", fontweight="bold", fontsize=8.5)
    left.text(0.70, -14.0, "in 1 s", color=PALETTE["blue"], fontweight="bold", fontsize=8.5)
    left.text(0.02, -1.5, "in 2 s", color="#007A58", fontweight="bold", fontsize=8.5)
    note(left, "to hold\nits weight", (0.8, 12.9), (0.7, 33), PALETTE["black"])
    left.set(xlim=(0, 1), ylim=(-70, 90))
    left.set_title("Inverse: what it takes")
    left.set_xlabel("share of the duration (1)")
    left.set_ylabel("shoulder torque (N m)")
    for load, feedback, line, color, width in (
        (0.0, False, "-", "blue", 3.2),
        (0.01, False, "--", "purple", 1.6),
        (LOAD_KG, False, ":", "vermillion", 1.8),
        (LOAD_KG, True, "-.", "black", 1.2),
    ):
        hand = driven(load, feedback=feedback)
        right.plot(hand[:, 0], hand[:, 1], color=PALETTE[color], linestyle=line, linewidth=width)
        right.plot(*hand[-1], marker="o", color=PALETTE[color])
    right.plot(*END, marker="o", markersize=10, markerfacecolor="none", color=PALETTE["black"])
    for x, y, text, color in (
        (-0.5, 0.1, "bare arm;\n0.1 kg with\nfeedback", PALETTE["blue"]),
        (1.05, 0.75, "0.01 kg more", "#9C4478"),
        (1.35, 0.08, "0.1 kg more", "#B34F00"),
    ):
        right.text(x, y, text, color=color, fontweight="bold", fontsize=8.5)
    right.set(xlim=(-0.6, 2.4), ylim=(-1.6, 1.6), aspect="equal")
    right.set_title("Forward: what happens")
    right.set_xlabel("x of the hand (m)")
    right.set_ylabel("y of the hand (m)")
    title(figure, "Faster motion needs more torque, and a forgotten load spoils the plan")
    return figure
