"""The same work spent in two ways: many iterations of one step, or one iteration of many small steps."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from course.physics.simulator import step_count
from course.physics.solver import Chain
from course.simulations.base import Column, Parameter, Result, Row, Simulation
from course.simulations.words import digits

if TYPE_CHECKING:
    from collections.abc import Mapping

__all__ = ["SIMULATION"]


def _run(p: Mapping[str, Any]) -> Result:
    chain = Chain(links=p["links"], length=p["length"])
    h, work = p["frame"], p["work"]
    n = step_count(p["duration"], h)
    if n * work * p["links"] > 2_000_000:
        raise ValueError(
            f"{n:,} frames of {work} iterations over {p['links']} links take too long; reduce one of them."
        )
    splits = [(k, work // k) for k in range(1, work + 1) if work % k == 0]
    if len(splits) > 6:
        splits = [splits[round(i * (len(splits) - 1) / 5)] for i in range(6)]
    series = {split: chain.stretch(p["duration"], h, *split) for split in splits}
    worst = {split: float(values.max()) for split, values in series.items()}
    rows = tuple(
        Row(f"greatest stretch, {_words(*split)}", stretch, "1", 0.0, "stiff links")
        for split, stretch in worst.items()
    )
    one, many = worst[splits[0]], worst[splits[-1]]
    better = f"{one / many:.2g} times" if many > 0 else "far"
    return Result(
        simulation="substeps",
        settings=p,
        rows=rows,
        headline=f"Same work: small steps stretch the chain {better} less than iterations do",
        finding=f"Every variant goes over the chain {work} times a frame. One step with {work} iterations "
        f"lets a link stretch by {digits(one, 2)} of its length, {work} steps with one iteration by "
        f"{digits(many, 2)}: "
        "a small step makes a small error, and the next step starts after it has been corrected.",
        columns=(
            Column.of("t", "s", h * np.arange(n + 1)),
            *(Column.of(f"stretch_{s}x{i}", "1", values) for (s, i), values in series.items()),
        ),
    )


def _words(steps: int, iterations: int) -> str:
    return f"{steps} substep{'s' * (steps > 1)} x {iterations} iteration{'s' * (iterations > 1)}"


SIMULATION = Simulation(
    id="substeps",
    title="Substeps: where to spend the work",
    question="A solver makes 16 iterations a frame: in one step, or in 16 steps with one each. With which "
    "does the chain stretch less, and by how much?",
    teaches="solver parameters; time step",
    parameters=(
        Parameter("links", 20, "1", "links of the chain", low=2, high=100),
        Parameter("length", 2.0, "m", "of the whole chain", low=0.01, high=100.0),
        Parameter("work", 16, "1", "iterations over the chain a frame", low=2, high=64),
        Parameter("frame", 1 / 60, "s", "time between frames", low=1e-3, high=0.1),
        Parameter(
            "duration", 2.0, "s", "how long to simulate; a whole number of frames", low=1e-3, high=60.0
        ),
    ),
    run=_run,
)
