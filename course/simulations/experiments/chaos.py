"""Two double pendulums a billionth of a radian apart: for how long do they agree?"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from course.physics.dynamics import PassiveArm, TwoLinkArm
from course.physics.integrators import RK4, State, trajectory
from course.physics.invariants import relative_change
from course.physics.simulator import step_count
from course.simulations.base import Column, Parameter, Result, Row, Simulation, duration, step
from course.simulations.words import digits, percent

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    Array = NDArray[np.float64]

__all__ = ["SIMULATION"]

_CROWD = 400  # pendulums whose average is compared between two steps
_SPREAD = 1e-3  # rad: how far apart they start
_SEED = 1
_FEWEST = 40  # steps


def _run(p: Mapping[str, Any]) -> Result:
    h = p["step"]
    n = step_count(p["duration"], h)
    if n < _FEWEST:
        raise ValueError(f"{n} steps are too few to see anything part; take {_FEWEST} or more.")
    first, second = math.radians(p["angle1_deg"]), math.radians(p["angle2_deg"])
    pair = np.array([[first, second], [first + p["nudge"], second]])
    pendulum = TwoLinkArm.double_pendulum()
    t, q, v = _swing(pendulum, pair, h, n)
    apart = np.max(np.abs(_from_hanging(q[:, 1]) - _from_hanging(q[:, 0])), axis=-1)
    small, large = _first_above(t, apart, 1e-3), _first_above(t, apart, 1.0)
    drift = float(np.max(np.abs(relative_change(pendulum.energy(q[:, 0], v[:, 0]) + _OFFSET))))
    coarse, fine = _crowd(pendulum, first, second, h, n)
    rows = (
        Row("separation passes 1e-3 rad", small, "s"),
        Row("separation passes 1 rad", large, "s"),
        Row("growth of the separation", _growth(t, apart, p["nudge"]), "1/s"),
        Row("energy error, at most", drift, "1", 0.0, "nothing drives or brakes"),
        Row(f"mean energy of the upper bob, {_CROWD} starts, step {4 * h:g} s", coarse, "J/kg"),
        Row(f"mean energy of the upper bob, {_CROWD} starts, step {2 * h:g} s", fine, "J/kg"),
    )
    return Result(
        simulation="chaos",
        settings=p,
        rows=rows,
        headline=_headline(p, large),
        finding=_finding(p, small, large, coarse, fine),
        columns=(
            Column.of("t", "s", t),
            Column.of("separation", "rad", apart),
            *(Column.of(f"angle{k + 1}_{name}", "rad", _from_hanging(q[:, i])[:, k])
              for i, name in enumerate(("a", "b")) for k in (0, 1)),
        ),
    )  # fmt: skip


#: Energy is counted from the lowest point, so that a share of it means something. In J.
_OFFSET = 3 * 9.81


def _swing(pendulum: TwoLinkArm, hanging: Array, h: float, n: int) -> tuple[Array, Array, Array]:
    """Let go of pendulums at angles from the downward vertical, shape (..., 2); the arm counts otherwise."""
    upper = hanging[..., 0] - math.pi / 2
    joints = np.stack([upper, hanging[..., 1] - hanging[..., 0]], axis=-1)
    return trajectory(RK4(), PassiveArm(pendulum), State.at_rest(joints), h, n)


def _from_hanging(q: Array) -> Array:
    """Angles of both rods from the downward vertical, rad."""
    return np.stack([q[..., 0] + math.pi / 2, q[..., 0] + q[..., 1] + math.pi / 2], axis=-1)


def _first_above(t: Array, values: Array, level: float) -> float:
    above = np.flatnonzero(values > level)
    return float(t[above[0]]) if above.size else math.nan


def _growth(t: Array, apart: Array, nudge: float) -> float:
    """Slope of the logarithm of the separation, from where it is ten times the nudge until it is 0.1 rad."""
    end = _first_above(t, apart, 0.1)
    fit = (apart > 10 * abs(nudge)) & (t < (end if math.isfinite(end) else math.inf))
    if np.count_nonzero(fit) < 5:
        return math.nan
    return float(np.polyfit(t[fit], np.log(apart[fit]), 1)[0])


def _crowd(pendulum: TwoLinkArm, first: float, second: float, h: float, n: int) -> tuple[float, float]:
    """Kinetic energy of the upper bob, averaged over many starts and the second half, at 4 h and at 2 h."""
    starts = np.array([first, second]) + _SPREAD * np.random.default_rng(_SEED).standard_normal((_CROWD, 2))
    means = []
    for longer in (4, 2):
        _, _, v = _swing(pendulum, starts, h * longer, n // longer)
        means.append(float(np.mean(0.5 * v[n // longer // 2 :, :, 0] ** 2)))
    return means[0], means[1]


def _headline(p: Mapping[str, Any], large: float) -> str:
    if math.isnan(large):
        return f"{p['nudge']:.0e} rad apart at the start, still close after {p['duration']:g} s"
    return f"{p['nudge']:.0e} rad apart at the start, more than 1 rad after {digits(large)} s"


def _finding(p: Mapping[str, Any], small: float, large: float, coarse: float, fine: float) -> str:
    if math.isnan(large):
        return (
            f"Within {p['duration']:g} s the two stay less than 1 rad apart. Start them higher, or run for "
            "longer, and they come further apart."
        )
    early = f"{digits(small)} s" if math.isfinite(small) else "the start"
    return (
        f"A difference of {p['nudge']:.0e} rad passes 0.001 rad after {early} and 1 rad after "
        f"{digits(large)} s. "
        "After that a comparison of two paths says nothing about a simulator, because an error in the last "
        f"digit grows like this too. Averages can still be compared: over {_CROWD} starts the energy of the "
        f"upper bob differs by {percent(abs(coarse / fine - 1))} between a step of {4 * p['step']:g} s and "
        "half of it."
    )


SIMULATION = Simulation(
    id="chaos",
    title="Chaos: how long does a prediction last?",
    question="Two double pendulums start a billionth of a radian apart. After how many seconds can you see "
    "the difference?",
    teaches="limits of accuracy",
    parameters=(
        Parameter("angle1_deg", 160.0, "deg", "upper rod at the start, from hanging", low=-180.0, high=180.0),
        Parameter("angle2_deg", -95.0, "deg", "lower rod at the start, from hanging", low=-180.0, high=180.0),
        Parameter("nudge", 1e-9, "rad", "how much further the second upper rod starts", low=1e-12, high=1.0),
        duration(15.0, high=100.0),
        step(0.005, high=0.05),
    ),
    run=_run,
)
