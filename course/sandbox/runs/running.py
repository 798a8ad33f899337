"""A run without a view: all events, and the answer to the scene's question."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import msgspec
import numpy as np

from course.sandbox.runs.probes import Probes
from course.sandbox.scene.loading import Chosen, values_of
from course.sandbox.scene.predicting import Comparison, compare
from course.sandbox.world.events import Event, Receipt
from course.sandbox.world.ledger import Floats
from course.sandbox.world.world import World

if TYPE_CHECKING:
    from collections.abc import Callable

    from course.sandbox.world.world import Snapshot

__all__ = ["COLUMNS", "Run", "finish", "run"]

#: Columns of a table of samples, with their units; a row for each body and sample, totals with each.
COLUMNS = (
    "t [s]",
    "body",
    "x [m]",
    "y [m]",
    "angle [rad]",
    "vx [m/s]",
    "vy [m/s]",
    "spin [rad/s]",
)
#: Rows of a table at most, so that a long run of a large scene gives a file that can be opened.
_MOST_ROWS = 200_000


class Run(msgspec.Struct, frozen=True, kw_only=True):
    """The results of a run.

    Attributes:
        duration: simulated time, in s.
        steps: made.
        events: all of them, in order.
        dropped: events that were too many to keep.
        receipt: at the end.
        momentum_before, momentum_after: along x and y in kg m/s, and angular in kg m²/s.
        probes: what the scene's probes read.
        comparison: the prediction's, if the scene asks for one.
        samples: time in s, and the state (n, 6) then, with the names of its rows.
        state_hash: of the end.
    """

    duration: float
    steps: int
    events: tuple[Event, ...]
    dropped: int
    receipt: Receipt
    momentum_before: tuple[float, float, float]
    momentum_after: tuple[float, float, float]
    probes: dict[str, float]
    comparison: Comparison | None
    samples: tuple[tuple[float, tuple[str, ...], Floats], ...]
    state_hash: str


def run(
    chosen: Chosen,
    *,
    duration: float | None = None,
    guess: float | None = None,
    every: float = 0.0,
    on_frame: Callable[[World, Snapshot], None] | None = None,
    fps: float = 25.0,
    also_at: tuple[float, ...] = (),
    watch: Callable[[World], None] | None = None,
) -> Run:
    """Run a scene to its end.

    Args:
        chosen: the scene with its settings.
        duration: in s; the scene's own if None.
        guess: the student's number, if one was asked for.
        every: keep a sample of all bodies this often, in s; 0 keeps none.
        on_frame: called ``fps`` times per simulated second, at the start and at the end.
        also_at: times of further frames, in s; those after the end are left out.
        watch: called with the world before it starts.
    """
    world = World(chosen.scene, chosen.settings)
    probes = Probes(world, chosen)
    if watch is not None:
        watch(world)
    until = chosen.scene.duration if duration is None else duration
    before = world.momentum
    events: list[Event] = []
    samples: list[tuple[float, tuple[str, ...], Floats]] = []
    stops = _stops(until, every, fps if on_frame else 0.0, also_at)
    moving = sum(not part.fixed for part in world.parts) or 1
    for t, is_sample, is_frame in stops:
        world.run_until(t)
        events += world.drain_events()
        if is_sample and len(samples) * moving < _MOST_ROWS:
            free = [i for i, part in enumerate(world.parts) if not part.fixed]
            samples.append((world.t, tuple(world.parts[i].name for i in free), world.state()[free]))
        if is_frame and on_frame is not None:
            on_frame(world, world.snapshot())
    return finish(world, probes, chosen, events, before, guess, tuple(samples))


def finish(
    world: World,
    probes: Probes,
    chosen: Chosen,
    events: list[Event],
    before: tuple[float, float, float],
    guess: float | None,
    samples: tuple[tuple[float, tuple[str, ...], Floats], ...] = (),
) -> Run:
    """The results of the run that a world has just made."""
    answers = probes.read(events)
    asked = chosen.scene.prediction
    comparison = None
    if asked is not None:
        # The run may have been told to be shorter or longer than the scene, and ends with a whole step.
        values = values_of(chosen) | {"duration": world.t}
        comparison = compare(asked, answers[asked.probe], values, guess)
    return Run(
        duration=world.t,
        steps=world.steps,
        events=tuple(events),
        dropped=world.dropped,
        receipt=world.receipt,
        momentum_before=before,
        momentum_after=world.momentum,
        probes=answers,
        comparison=comparison,
        samples=samples,
        state_hash=world.state_hash(),
    )


def _stops(
    until: float, every: float, fps: float, also_at: tuple[float, ...]
) -> list[tuple[float, bool, bool]]:
    """The times to stop at, in s, and whether for a sample or for a frame."""
    # Events are fetched at least once a second so that none is dropped for want of room.
    times: dict[float, list[bool]] = {}
    for interval, kind in ((1.0, None), (every, 0), (1.0 / fps if fps else 0.0, 1)):
        if interval <= 0.0:
            continue
        for t in (np.arange(math.floor(until / interval + 1e-9) + 1) * interval).tolist():
            flags = times.setdefault(round(t, 9), [False, False])
            if kind is not None:
                flags[kind] = True
    for t in also_at:
        if t <= until:
            times.setdefault(round(t, 9), [False, False])[1] = True
    last = times.setdefault(round(until, 9), [False, False])
    last[0] = last[0] or every > 0.0
    return [(t, sample, frame) for t, (sample, frame) in sorted(times.items())]
