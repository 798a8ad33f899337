"""A run without a view: all events, and the answer to the scene's question."""

import math
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import Any

import msgspec
import numpy as np

from course.printable import counted
from course.sandbox.scene.expression import evaluate
from course.sandbox.scene.loading import Chosen, Comparison, compare, values_of, with_settings
from course.sandbox.scene.model import Probe, Scene, layout
from course.sandbox.scene.rules import matching
from course.sandbox.world.accounts import MINOR, Event, Receipt
from course.sandbox.world.engine import Block, Floats
from course.sandbox.world.world import Snapshot, World

# ---
# Numbers read from a run: the scene's probes.


_COLUMN = {"x": 0, "y": 1, "angle_deg": 2, "vx": 3, "vy": 4, "spin": 5}


class Probes:
    """Watches a world and answers its scene's probes at the end.

    Args:
        world: before its first step. It must keep an energy account, because the states of each step come
            from there.
        chosen: its scene, with the parameters that went into it.
    """

    def __init__(self, world: World, chosen: Chosen) -> None:
        self._world, self._chosen = world, chosen
        self._scene: Scene = world.scene
        names = tuple(part.name for part in layout(self._scene))
        self._of = {probe.name: matching(probe.of, names) for probe in self._scene.probe}
        self._start: dict[str, float] = {}
        self._found: dict[str, float] = {}
        self._times: dict[str, float] | None = None
        state = world.state()
        for probe in self._scene.probe:
            self._start[probe.name] = self._value(probe, state)
            if probe.when in {"start", "max", "min"}:
                self._found[probe.name] = self._start[probe.name]
        world.on_block.append(self._watch)

    def read(self, events: Sequence[Event]) -> dict[str, float]:
        """The answers, by probe; "nan" for what did not happen.

        Args:
            events: everything the world reported since its start.
        """
        state = self._world.state()
        return {probe.name: self._answer(probe, state, events) for probe in self._scene.probe}

    def compared(self, answers: Mapping[str, float], guess: float | None) -> Comparison | None:
        """The answers beside theory and guess; None if the scene asks for no number."""
        asked = self._scene.prediction
        if asked is None:
            return None
        # The run may have been told to be shorter or longer than the scene, and ends with a whole step.
        values = values_of(self._now()) | {"duration": self._world.t}
        return compare(asked, answers[asked.probe], values, guess, self._scene.duration)

    def _now(self) -> Chosen:
        return with_settings(self._chosen, self._world.settings)

    def _answer(self, probe: Probe, state: Floats, events: Sequence[Event]) -> float:
        if probe.quantity in {"contacts", "contact_time"}:
            mine = [event for event in events if self._is_contact(probe, event)]
            if probe.quantity == "contacts":
                return float(sum(not event.minor for event in mine)) * probe.scale
            return mine[0].t * probe.scale if mine else math.nan
        ends = probe.when == "end"
        value = self._value(probe, state) if ends else self._found.get(probe.name, math.nan)
        return (value - self._start[probe.name] * probe.change) * probe.scale

    def _watch(self, block: Block) -> None:
        """Read the probes that are due at a moment of their own."""
        if self._times is None:
            self._times = self._moments()
        for probe in self._scene.probe:
            if probe.when in {"max", "min"}:
                best = max if probe.when == "max" else min
                for state in block.states:
                    self._found[probe.name] = best(self._found[probe.name], self._value(probe, state))
            elif probe.when == "at" and probe.name not in self._found:
                # The first step that ends there or later; times are exact multiples, but for rounding.
                rows = np.flatnonzero(block.times >= self._times[probe.name] - 1e-9)
                if len(rows):
                    self._found[probe.name] = self._value(probe, block.states[rows[0]])
            elif probe.when == "after" and probe.name not in self._found:
                row = self._first_contact(probe, block)
                if row is not None:
                    self._found[probe.name] = self._value(probe, block.states[row])

    def _moments(self) -> dict[str, float]:
        """When probes read, by the settings at the first step: until then they may change."""
        given = {p.name: p.time for p in self._scene.probe if p.time is not None}
        values = values_of(self._now()) if any(isinstance(time, str) for time in given.values()) else {}
        return {name: evaluate(at, values) if isinstance(at, str) else at for name, at in given.items()}

    def _first_contact(self, probe: Probe, block: Block) -> int | None:
        """The step of the block in which the probe's two met."""
        index = {part.name: i for i, part in enumerate(self._world.parts)}
        a, b = index.get(self._of[probe.name][0]), index.get(probe.other or "")
        contacts = block.contacts
        met = ((contacts.a == a) & (contacts.b == b)) | ((contacts.a == b) & (contacts.b == a))
        rows = contacts.row[met & (contacts.first == 1)]
        return int(rows.min()) if len(rows) else None

    def _is_contact(self, probe: Probe, event: Event) -> bool:
        if event.kind != "contact":
            return False
        mine, pairs = self._of[probe.name], ((event.a, event.b), (event.b, event.a))
        return any(one in mine and probe.other in {None, other} for one, other in pairs)

    def _value(self, probe: Probe, state: Floats) -> float:
        """The quantity in one state; "nan" if none of its bodies is there."""
        index = {part.name: i for i, part in enumerate(self._world.parts)}
        rows = [index[name] for name in self._of[probe.name] if name in index]
        if not rows or len(state) != len(index):
            return math.nan
        mine = state[rows]
        if probe.quantity in _COLUMN:
            value = float(mine[0, _COLUMN[probe.quantity]])
            return math.degrees(value) if probe.quantity == "angle_deg" else value
        return self._of_many(probe, mine, rows)

    def _of_many(self, probe: Probe, mine: Floats, rows: list[int]) -> float:
        parts = [self._world.parts[i] for i in rows]
        mass = np.array([part.mass for part in parts])
        x, y, _, vx, vy, spin = mine.T
        value: Any = 0.0
        if probe.quantity == "speed":
            value = np.hypot(vx[0], vy[0])
        elif probe.quantity == "kinetic":
            inertia = np.array([part.moment if math.isfinite(part.moment) else 0.0 for part in parts])
            value = (mass @ (vx**2 + vy**2) + inertia @ spin**2) / 2
        elif probe.quantity == "momentum_x":
            value = mass @ vx
        elif probe.quantity == "count" and probe.region is not None:
            left, bottom, right, top = probe.region
            value = ((x >= left) & (x < right) & (y >= bottom) & (y < top)).sum()
        elif probe.quantity == "mean":
            value = x.mean()
        elif probe.quantity == "spread":
            value = x.std()
        return float(value)


#: Columns of a table of samples, with their units; a row for each body and sample, totals with each.
COLUMNS = ("t [s]", "body", "x [m]", "y [m]", "angle [rad]", "vx [m/s]", "vy [m/s]", "spin [rad/s]")
#: Rows of a table at most, so that a long run of a large scene gives a file that can be opened.
_MOST_ROWS = 200_000
#: How often momentum is looked at, in simulated s.
_LOOK = 1 / 60


class Run(msgspec.Struct, frozen=True, kw_only=True):
    """The results of a run.

    Attributes:
        duration: simulated time, in s.
        dropped: events that were too many to keep.
        momentum_before, momentum_after: along x and y in kg m/s, and angular in kg m²/s.
        momentum_least, momentum_most: along x and y, on the way.
        probes: what the scene's probes read.
        comparison: the prediction's, if the scene asks for one.
        samples: time in s, and the state (n, 6) then, with the names of its rows.
    """

    duration: float
    steps: int
    events: tuple[Event, ...]
    dropped: int
    receipt: Receipt
    momentum_before: tuple[float, float, float]
    momentum_after: tuple[float, float, float]
    momentum_least: tuple[float, float]
    momentum_most: tuple[float, float]
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
        duration: in s; the scene's own if None.
        guess: the student's number, if one was asked for.
        every: keep a sample of all bodies this often, in s; 0 keeps none.
        on_frame: called with the world and what it shows, for each frame.
        fps: frames per simulated second, beside those at the start and at the end.
        also_at: times of further frames, in s; those after the end are left out.
        watch: called with the world before it starts.
    """
    world = World(chosen.scene, chosen.settings)
    probes = Probes(world, chosen)
    if watch is not None:
        watch(world)
    until = chosen.scene.duration if duration is None else duration
    before = world.momentum
    least = most = np.array(before[:2])

    def look() -> None:
        nonlocal least, most
        now = world.momentum[:2]
        least, most = np.minimum(least, now), np.maximum(most, now)

    world.on_tick.append((max(1, round(_LOOK / world.settings["step"])), look))
    events: list[Event] = []
    samples: list[tuple[float, tuple[str, ...], Floats]] = []
    moving = sum(not part.fixed for part in world.parts) or 1
    for t, is_sample, is_frame in _stops(until, every, fps if on_frame else 0.0, also_at):
        world.run_until(t)
        events += world.drain_events()
        look()
        if is_sample and len(samples) * moving < _MOST_ROWS:
            free = [i for i, part in enumerate(world.parts) if not part.fixed]
            samples.append((world.t, tuple(world.parts[i].name for i in free), world.state()[free]))
        if is_frame and on_frame is not None:
            on_frame(world, world.snapshot())
    answers = probes.read(events)
    return Run(
        duration=world.t,
        steps=world.steps,
        events=tuple(events),
        dropped=world.dropped,
        receipt=world.receipt,
        momentum_before=before,
        momentum_after=world.momentum,
        momentum_least=tuple(least.tolist()),
        momentum_most=tuple(most.tolist()),
        probes=answers,
        comparison=probes.compared(answers, guess),
        samples=tuple(samples),
        state_hash=world.state_hash(),
    )


def _stops(
    until: float, every: float, fps: float, also_at: tuple[float, ...]
) -> list[tuple[float, bool, bool]]:
    """The times to stop at, in s, and whether for a sample or for a frame."""

    def often(interval: float) -> set[float]:
        if interval <= 0.0:
            return set()
        times = np.arange(math.floor(until / interval + 1e-9) + 1) * interval
        return {round(t, 9) for t in times.tolist()}

    end = round(until, 9)
    samples = often(every) | ({end} if every > 0.0 else set())
    frames = often(1.0 / fps if fps else 0.0) | {round(t, 9) for t in also_at if t <= until}
    # Events are fetched at least once a second so that none is dropped for want of room.
    stops = samples | frames | often(1.0) | {end}
    return [(t, t in samples, t in frames) for t in sorted(stops)]


# ---
# A run in sentences, from the same events that pictures are drawn from.


#: A pair that touches again within this time, in s, is not reported each time.
_PATIENCE = 0.05
#: Changes of energy below this share are not worth a clause.
_WORTH = 0.005


def sentence(event: Event) -> str:
    """One event in words, with the time in front: "0.42 s: the ball meets the floor at 4.09 m/s ..."."""
    when = f"{event.t:.2f} s: "
    if event.kind == "contact":
        return when + _contact(event)
    if event.kind == "rest":
        return f"{when}{_the(event.a)} comes to rest at x = {_place(event.x)} m, y = {_place(event.y)} m."
    if event.kind == "gone":
        return f"{when}{_the(event.a)} has left the scene."
    text = event.text
    for name in {event.a, event.b} - {""}:
        text = re.sub(rf"(?<=\b){re.escape(name)}(?![\w-])", _the(name), text)
    return f"{when}{text}."


def _place(value: float) -> str:
    """To the centimetre, and never "-0.00"."""
    return f"{round(value, 2) + 0.0:.2f}"


def sentences(events: Iterable[Event], most: int = 40) -> Iterator[str]:
    """The events worth reporting, and at the end how many were left out.

    Args:
        events: in order.
        most: sentences at most, the last one not counted.
    """
    last: dict[tuple[str, str], float] = {}
    told = left = 0
    for event in events:
        if event.kind == "contact" and not worth_telling(event, last):
            left += not event.minor
            continue
        if told >= most:
            left += 1
            continue
        told += 1
        yield sentence(event)
    if left:
        yield f"{counted(left, 'more event')} happened; --json has every one."


def worth_telling(contact: Event, last: dict[tuple[str, str], float]) -> bool:
    """Whether a contact is hard enough, and its pair did not meet as hard a moment ago.

    Args:
        last: when each pair met last, in s; this contact is noted in it, unless it is soft: balls of a chain
            touch softly just before they are hit.
    """
    if contact.minor:
        return False
    pair = (contact.a, contact.b)
    since = contact.t - last.get(pair, -1.0)
    last[pair] = contact.t
    # Time that runs backwards is a world that was reset.
    return not 0.0 <= since < _PATIENCE


def account(receipt: Receipt) -> list[str]:
    """The energy account in sentences."""
    had = receipt.start + receipt.given
    scale = max(abs(had), abs(receipt.kinetic), abs(receipt.contacts), abs(receipt.friction), 1e-12)
    contacts, friction, rods = (
        part if abs(part) > 1e-9 * scale else 0.0
        for part in (receipt.contacts, receipt.friction, receipt.rods)
    )
    kinetic = receipt.kinetic if receipt.kinetic > 1e-12 * scale else 0.0
    how = "given" if receipt.given > 0 else "taken out"
    lines = [
        f"Energy at the start {_joule(receipt.start)}"
        + (f", {how} since {_joule(abs(receipt.given))}" if abs(receipt.given) > 1e-9 else "")
        + f"; now {_joule(kinetic)} of motion and {_joule(receipt.potential)} of height."
    ]
    in_rods = f", lost in rods {_joule(rods)}" if rods else ""
    lines.append(f"Lost in contacts {_joule(contacts)}, lost to friction {_joule(friction)}{in_rods}.")
    share = abs(receipt.residual) / scale
    if share < 1e-9:
        lines.append("Nothing is unaccounted for.")
    else:
        verb = "is missing without a physical cause" if receipt.residual > 0 else "has no physical source"
        percent = float(f"{100 * share:.2g}")
        lines.append(f"{_joule(abs(receipt.residual))} {verb}: that is the solver's ({percent:g} %).")
    return lines


def momentum(done: Run) -> list[str]:
    """The change of momentum, in a sentence."""
    (px, py, _), (qx, qy, _) = done.momentum_before, done.momentum_after
    # Rounding: of sums of momenta their billionth, of bodies at rest what is far below all in a scene.
    near = max(1e-9 * max(abs(px), abs(py), abs(qx), abs(qy)), 1e-12)
    now = f"({qx if abs(qx) > near else 0.0:.4g}, {qy if abs(qy) > near else 0.0:.4g}) kg m/s"
    if abs(qx - px) <= near and abs(qy - py) <= near:
        if max(np.subtract(done.momentum_most, done.momentum_least)) <= near:
            return [f"Momentum is kept: {now}."]
        return [f"Momentum ends as it began, {now}, and changed in between: something outside took part."]
    was = f"({px:.4g}, {py:.4g})"
    return [f"Momentum went from {was} to {now}: something outside took part."]


def _contact(event: Event) -> str:
    a, b = _the(event.a), _the(event.b)
    if event.approach < -MINOR:
        way = "they move" if event.shared else "moves"
        return f"{a} is found inside {b} and {way} apart at {-event.approach:.2f} m/s."
    # Both speeds are relative: of two bodies that can move, neither is said to be the one that leaves.
    text = f"{a} and {b} meet" if event.shared else f"{a} meets {b}"
    text += f" at {event.approach:.2f} m/s"
    if event.leave is None:
        return f"{text}."
    if event.leave > 0.01:
        text += f" and {'part' if event.shared else 'leaves'} at {event.leave:.2f}"
    else:
        text += " and stay together" if event.shared else " and stays with it"
    share = event.lost
    if share is None or event.before is None or event.before < 1e-9:
        return f"{text}."
    whose = "their" if event.shared else "its"
    if abs(share) < _WORTH:
        return f"{text}; none of {whose} kinetic energy is gone."
    if share < 0:
        return f"{text}; {whose} kinetic energy grew by {-100 * share:.0f} %, pushed by others."
    much = "all" if share > 1 - 1e-9 else "nearly all" if share > 0.995 else f"{100 * share:.0f} %"
    return f"{text}; {much} of {whose} kinetic energy is gone."


def _the(name: str) -> str:
    """A body's name in a sentence: ``ball-3`` is "ball 3", ``floor`` is "the floor"."""
    words = name.replace("-", " ")
    return words if words[-1:].isdigit() else f"the {words}"


def _joule(value: float) -> str:
    return f"{value:.4g} J"
