"""A stack of boxes and a solver that goes over its contacts one by one: how often must it go?"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from course.physics.solver import Chain, iterations_to, stack_impulses
from course.simulations.base import Column, Parameter, Result, Row, Simulation
from course.simulations.words import percent

if TYPE_CHECKING:
    from collections.abc import Mapping

__all__ = ["SIMULATION"]

_STACKS = (2, 5, 10, 20)
_CHAIN_ITERATIONS = (4, 16, 64)


def _run(p: Mapping[str, Any]) -> Result:
    boxes, tolerance, last = p["boxes"], p["tolerance"], p["iterations"]
    heights = tuple(sorted({*_STACKS, boxes}))
    needed = {count: iterations_to(count, tolerance) for count in heights}
    histories = {count: stack_impulses(count, last)[:, 0] / count for count in heights}
    rows = [Row(f"iterations to {percent(tolerance)}, {n} boxes", k, "1") for n, k in needed.items()]
    rows += [
        Row(f"error left per iteration, {n} boxes", _rate(n), "1", math.cos(math.pi / (2 * n)) ** 2,
            "cos²(π / (2 n))")
        for n in heights
    ]  # fmt: skip
    chain = {k: float(Chain().stretch(2.0, 1 / 60, 1, k).max()) for k in _CHAIN_ITERATIONS}
    rows += [Row(f"20-link chain, stretch after {k} iterations a frame", s, "1", 0.0, "stiff links")
             for k, s in chain.items()]  # fmt: skip
    done = float(histories[boxes][-1])
    tall, short = heights[-1], heights[0]
    return Result(
        simulation="solver-iterations",
        settings=p,
        rows=tuple(rows),
        headline=f"{tall} boxes need {needed[tall]} iterations to reach {percent(tolerance)}, "
        f"{short} need {needed[short]}",
        finding=f"After {last} iterations from zero the ground carries {percent(done)} of the weight of "
        f"{boxes} boxes. To come within {percent(tolerance)} takes {needed[boxes]} iterations, and the "
        "number grows with the square of the height, because each iteration passes a load on only to the "
        "next contact. "
        "Engines start from the answer of the last step instead, so a stack that stands still stays up.",
        columns=(
            Column.of("iteration", "1", np.arange(last + 1)),
            *(Column.of(f"load_{n}_boxes", "1", history) for n, history in histories.items()),
        ),
    )


def _rate(boxes: int) -> float:
    """By which factor the error of the lowest impulse shrinks per iteration, once it shrinks evenly."""
    start = 2 * boxes * boxes
    errors = boxes - stack_impulses(boxes, start + 1)[:, 0]
    # Round-off drowns the ratio when little is left; step back to where there is enough.
    good = int(np.flatnonzero(errors > 1e-9 * boxes)[-1])
    return float(errors[good] / errors[good - 1])


SIMULATION = Simulation(
    id="solver-iterations",
    title="Solver: how many iterations does a stack need?",
    question="Two boxes need 7 iterations before the ground carries their weight to 1 %. How many do twenty "
    "need: 70, 200, 700?",
    teaches="solver parameters",
    parameters=(
        Parameter("boxes", 20, "1", "height of the stack", low=2, high=60),
        Parameter("tolerance", 0.01, "1", "error that is allowed, a share", low=1e-4, high=0.5),
        Parameter("iterations", 800, "1", "how many to show", low=1, high=20_000),
    ),
    run=_run,
)
