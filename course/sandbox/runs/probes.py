"""Numbers read from a run: the scene's probes."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from course.sandbox.scene.expression import evaluate
from course.sandbox.scene.loading import values_of, with_settings
from course.sandbox.scene.parts import layout
from course.sandbox.scene.rules import matching

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from course.sandbox.scene.loading import Chosen
    from course.sandbox.scene.model import Probe, Scene
    from course.sandbox.world.events import Event
    from course.sandbox.world.ledger import Block, Floats
    from course.sandbox.world.world import World

__all__ = ["Probes"]

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
            self._take(probe, self._start[probe.name])
        world.on_block.append(self._watch)

    def read(self, events: Sequence[Event]) -> dict[str, float]:
        """The answers, by probe; "nan" for what did not happen.

        Args:
            events: everything the world reported since its start.
        """
        state = self._world.state()
        return {probe.name: self._answer(probe, state, events) for probe in self._scene.probe}

    def _answer(self, probe: Probe, state: Floats, events: Sequence[Event]) -> float:
        if probe.quantity in {"contacts", "contact_time"}:
            mine = [event for event in events if self._is_contact(probe, event)]
            if probe.quantity == "contacts":
                return float(sum(not event.minor for event in mine)) * probe.scale
            return mine[0].t * probe.scale if mine else math.nan
        if probe.when == "end":
            value = self._value(probe, state)
        elif probe.when == "start":
            value = self._start[probe.name]
        else:
            value = self._found.get(probe.name, math.nan)
        return (value - self._start[probe.name] * probe.change) * probe.scale

    def _watch(self, block: Block) -> None:
        """Read the probes that are due at a moment of their own."""
        if self._times is None:
            self._times = self._moments()
        for probe in self._scene.probe:
            if probe.when in {"max", "min"}:
                for state in block.states:
                    self._take(probe, self._value(probe, state))
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
        values: Mapping[str, float] = {}
        if any(isinstance(time, str) for time in given.values()):
            values = values_of(with_settings(self._chosen, self._world.settings))
        return {
            name: evaluate(time, values) if isinstance(time, str) else time for name, time in given.items()
        }

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
        mine = self._of[probe.name]
        if probe.other is None:
            return event.a in mine or event.b in mine
        return (event.a in mine and event.b == probe.other) or (event.b in mine and event.a == probe.other)

    def _take(self, probe: Probe, value: float) -> None:
        if probe.when in {"max", "min"}:
            best = max if probe.when == "max" else min
            self._found[probe.name] = best(self._found.get(probe.name, value), value)

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
        value: Any = 0.0
        if probe.quantity == "speed":
            value = np.hypot(mine[0, 3], mine[0, 4])
        elif probe.quantity == "kinetic":
            inertia = np.array([part.moment if math.isfinite(part.moment) else 0.0 for part in parts])
            value = (mass @ (mine[:, 3] ** 2 + mine[:, 4] ** 2) + inertia @ mine[:, 5] ** 2) / 2
        elif probe.quantity == "momentum_x":
            value = mass @ mine[:, 3]
        elif probe.quantity == "count" and probe.region is not None:
            left, bottom, right, top = probe.region
            inside = (mine[:, 0] >= left) & (mine[:, 0] < right) & (mine[:, 1] >= bottom) & (mine[:, 1] < top)
            value = inside.sum()
        elif probe.quantity == "mean":
            value = mine[:, 0].mean()
        elif probe.quantity == "spread":
            value = mine[:, 0].std()
        return float(value)
