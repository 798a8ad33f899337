"""An arm of two links: plan a path (kinematics), find the torques (inverse), let them act (forward)."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from course.physics.dynamics import HandPath, TwoLinkArm
from course.physics.integrators import RK4, State, trajectory
from course.physics.simulator import step_count
from course.simulations.base import Column, Parameter, Result, Row, Simulation, duration, step

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import ArrayLike, NDArray

    Array = NDArray[np.float64]

__all__ = ["SIMULATION"]


class _Driven:
    """An arm under the torques that a plan computed for another one: open loop, no feedback."""

    def __init__(self, arm: TwoLinkArm, planned: TwoLinkArm, path: HandPath) -> None:
        self.arm, self.planned, self.path = arm, planned, path

    def __call__(self, t: float, q: ArrayLike, v: ArrayLike) -> Array:
        return self.arm.forward(q, v, self.planned.inverse(*self.path.joints(self.planned, t)))

    def params(self) -> dict[str, Any]:
        return {}


def _run(p: Mapping[str, Any]) -> Result:
    arm = TwoLinkArm()
    path = HandPath((p["start_x"], p["start_y"]), (p["end_x"], p["end_y"]), p["duration"])
    h = p["step"]
    n = step_count(p["duration"], h)
    t = h * np.arange(n + 1)
    planned, rates, accelerations = path.joints(arm, t)
    torques = arm.inverse(planned, rates, accelerations)
    real = _with_payload(arm, p["payload"])
    run = trajectory(RK4(), _Driven(real, arm, path), State.of(planned[0], rates[0]), h, n)
    back = arm.inverse(planned, rates, arm.forward(planned, rates, torques))
    missed = float(np.linalg.norm(real.hand(run.q[-1]) - np.asarray(path.end)))
    rows = (
        *_kinematic_rows(p, arm, path, planned),
        *_inverse_rows(arm, planned[0], torques),
        Row("inverse(forward(torque)) - torque, at most", float(np.max(np.abs(back - torques))), "N m", 0.0,
            "the two undo each other"),
        Row("hand off its goal after the forward run", missed, "m", 0.0, "same arm, same torques"),
        _work_row(real, run.q, run.v, torques, t),
    )  # fmt: skip
    hand, goal = real.hand(run.q), path.hand(t)[0]
    return Result(
        simulation="dynamics",
        settings=p,
        rows=rows,
        headline=_headline(p, missed),
        finding=_finding(p, missed, torques),
        columns=(
            Column.of("t", "s", t),
            *(Column.of(f"q{k + 1}_planned", "rad", planned[:, k]) for k in (0, 1)),
            *(Column.of(f"torque{k + 1}", "N m", torques[:, k]) for k in (0, 1)),
            *(Column.of(f"q{k + 1}", "rad", run.q[:, k]) for k in (0, 1)),
            *(Column.of(f"hand_{axis}", "m", hand[:, k]) for k, axis in enumerate("xy")),
            *(Column.of(f"planned_{axis}", "m", goal[:, k]) for k, axis in enumerate("xy")),
        ),
    )


def _with_payload(arm: TwoLinkArm, mass: float) -> TwoLinkArm:
    """The same arm with a point mass in its hand."""
    whole = arm.mass2 + mass
    centre = (arm.mass2 * arm.centre2 + mass * arm.length2) / whole
    inertia = (
        arm.inertia2 + arm.mass2 * (centre - arm.centre2) ** 2 + mass * (arm.length2 - centre) ** 2
    )  # about the new centre of mass
    return replace(arm, mass2=whole, centre2=centre, inertia2=inertia)


def _kinematic_rows(p: Mapping[str, Any], arm: TwoLinkArm, path: HandPath, planned: Array) -> tuple[Row, Row]:
    hand = arm.hand(planned)
    line = np.subtract(path.end, path.start)
    length = float(np.linalg.norm(line))
    aside = np.abs((hand - path.start) @ np.array([-line[1], line[0]])) / length
    # The joints decide, not the formula: differences of the hand they make.
    fastest = float(np.max(np.linalg.norm(np.diff(hand, axis=0), axis=-1))) / p["step"]
    return (
        Row("kinematic: hand off the straight line, at most", float(aside.max()), "m", 0.0, "the plan"),
        Row(
            "kinematic: greatest speed of the hand",
            fastest,
            "m/s",
            1.875 * length / p["duration"],
            "15/8 d / T",
        ),
    )


def _inverse_rows(arm: TwoLinkArm, q: Array, torques: Array) -> tuple[Row, Row]:
    """Torques that hold the arm at the start, against plain levers: weight times distance."""
    lever1 = arm.centre1 * np.cos(q[0])
    lever2 = arm.length1 * np.cos(q[0]) + arm.centre2 * np.cos(q[0] + q[1])
    shoulder = float(arm.g * (arm.mass1 * lever1 + arm.mass2 * lever2))
    elbow = float(arm.g * arm.mass2 * arm.centre2 * np.cos(q[0] + q[1]))
    return (
        Row(
            "inverse: shoulder torque at the start",
            float(torques[0, 0]),
            "N m",
            shoulder,
            "weights times levers",
        ),
        Row("inverse: elbow torque at the start", float(torques[0, 1]), "N m", elbow, "weight times lever"),
    )


def _work_row(arm: TwoLinkArm, q: Array, v: Array, torques: Array, t: Array) -> Row:
    power = np.sum(torques * v, axis=-1)
    work = float(np.sum(0.5 * (power[1:] + power[:-1]) * np.diff(t)))
    gained = float(arm.energy(q[-1], v[-1]) - arm.energy(q[0], v[0]))
    return Row("forward: energy gained", gained, "J", work, "work of the torques, by trapezes")


def _headline(p: Mapping[str, Any], missed: float) -> str:
    if p["payload"] > 0:
        return f"A load of {p['payload']:g} kg is not in the model: the hand misses by {missed:.2g} m"
    return "Torques from inverse dynamics carry the hand along the planned line"


def _finding(p: Mapping[str, Any], missed: float, torques: Array) -> str:
    peak = np.max(np.abs(torques), axis=0)
    plan = (
        "Kinematics plans the joint angles of a straight line without any forces; inverse dynamics says "
        f"which torques that takes, up to {peak[0]:.3g} N m at the shoulder and {peak[1]:.3g} N m at the "
        "elbow; "
        "forward dynamics says what those torques do. "
    )
    if p["payload"] > 0:
        return (
            f"{plan}The real arm carries {p['payload']:g} kg that is not in the plan, and its hand "
            f"ends {missed:.2g} m from the goal. Torques are only as good as the model, and nothing here "
            "pulls "
            "the arm back. A controller would do that with feedback."
        )
    return f"{plan}The hand ends {missed:.1e} m from its goal, because here plan and arm are the same model."


SIMULATION = Simulation(
    id="dynamics",
    title="Forward, inverse and kinematic: one arm, three questions",
    question="The torques were computed for an arm of 2 kg with an empty hand. If it holds 10 g, how far "
    "from its goal does it end: a millimetre, a centimetre, more?",
    teaches="kinds of simulation; model complexity",
    parameters=(
        Parameter("start_x", 1.2, "m", "where the hand starts", low=-2.0, high=2.0),
        Parameter("start_y", -0.8, "m", "where the hand starts", low=-2.0, high=2.0),
        Parameter("end_x", 0.6, "m", "where the hand should end", low=-2.0, high=2.0),
        Parameter("end_y", 1.2, "m", "where the hand should end", low=-2.0, high=2.0),
        Parameter("payload", 0.0, "kg", "in the hand, not in the plan", low=0.0, high=10.0),
        duration(1.0, high=100.0),
        step(high=0.1),
    ),
    run=_run,
)
