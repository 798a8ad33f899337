"""The accounts of a running world: where energy came from, where it went, and a minute of history."""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from course.sandbox.world.engine import Recorder
from course.sandbox.world.events import Receipt
from course.sandbox.world.ledger import Block, Ledger
from course.sandbox.world.pushes import brake, drive

if TYPE_CHECKING:
    from course.sandbox.scene.model import Floor
    from course.sandbox.scene.parts import Part
    from course.sandbox.world.engine import Space
    from course.sandbox.world.ledger import Floats
    from course.sandbox.world.pushes import Hand

__all__ = ["BLOCK", "Accounts", "Clock", "History"]

#: Steps that are booked together. More would save nothing, because the arrays would not fit the cache.
BLOCK = 32
#: How often the history is sampled, in s of simulated time, and how many samples are kept.
_SAMPLE = 1 / 60
_KEPT = 3600
#: The gravity that presses wheels onto the ground of a scene without a floor, in m/s².
_WEIGHT = 9.81


@dataclass(frozen=True, slots=True)
class History:
    """The last minute at about 60 samples a second; each array (k,), in s, J, kg m/s and kg m²/s."""

    t: Floats
    kinetic: Floats
    potential: Floats
    contacts: Floats
    friction: Floats
    rods: Floats
    residual: Floats
    px: Floats
    py: Floats
    angular: Floats


@dataclass(slots=True)
class Clock:
    """Time as a number of steps since the step size was last changed: never a running sum.

    Attributes:
        since, at: the time in s and the number of steps when the size was last changed.
        size: of a step, in s.
        steps: made so far.
    """

    size: float
    since: float = 0.0
    at: int = 0
    steps: int = 0

    @property
    def t(self) -> float:
        """In s."""
        return self.since + (self.steps - self.at) * self.size

    def resize(self, size: float) -> None:
        """Go on with steps of another size."""
        self.since, self.at = self.t, self.steps
        self.size = size

    def ends(self, first: int, count: int) -> Floats:
        """The times at which steps end, in s: ``count`` of them from number ``first``."""
        numbers: Floats = np.arange(first - self.at, first - self.at + count, dtype=np.float64)
        numbers *= self.size
        numbers += self.since
        return numbers


class Accounts:
    """The accounts of one space.

    Args:
        space: whose bodies.
        gravity: in m/s².
        joints: whether there are any.
    """

    def __init__(self, space: Space, gravity: tuple[float, float], clock: Clock, *, joints: bool) -> None:
        self.space = space
        self.clock = clock
        self.recorder = Recorder(space, both_points=joints)
        self.ledger = Ledger(space.parts, gravity, joints=joints)
        #: The state that the next step starts from; (n, 6).
        self.base = space.state()
        self.ledger.start = self._energy()
        self._history: deque[list[float]] = deque(maxlen=_KEPT)
        #: By row of the block to come: velocities after a push, energy given by it, energy rubbed off.
        self._pushes: dict[int, tuple[Floats, float, float]] = {}
        #: By row of the block to come: the body that a hand held, and the impulses of the hand.
        self._held: dict[int, tuple[int, tuple[float, float, float]]] = {}
        #: What joints will take in the next step, in J.
        self._to_rods = space.stopped_by_joints()
        self._remember(np.zeros(1), self.base[None], np.zeros((1, 4)))

    # -- reading ---------------------------------------------------------------------------------

    def receipt(self) -> Receipt:
        """Where the energy is; call ``close`` first."""
        ledger = self.ledger
        kinetic, potential = ledger.kinetic(self.base), ledger.potential(self.base)
        spent = kinetic + potential + ledger.contacts + ledger.friction + ledger.rods
        return Receipt(
            start=ledger.start,
            given=ledger.given,
            kinetic=kinetic,
            potential=potential,
            contacts=ledger.contacts,
            friction=ledger.friction,
            rods=ledger.rods,
            residual=ledger.start + ledger.given - spent,
            integrator=ledger.integrator,
        )

    def history(self) -> History:
        """The last minute; call ``close`` first."""
        return History(*np.array(self._history).reshape(-1, 10).T)

    # -- booking ---------------------------------------------------------------------------------

    def close(self) -> Block | None:
        """Book the steps that were only copied so far, and give them back; None if there were none."""
        count = len(self.recorder)
        if not count:
            return None
        states, contacts = self.recorder.block()
        first = self.clock.steps - count + 1
        block = Block(
            first_step=first,
            times=self.clock.ends(first, count),
            before=np.concatenate([self.base[None, :, 3:], states[:-1, :, 3:]]),
            states=states,
            contacts=contacts,
        )
        given, rubbed = np.zeros(count), np.zeros(count)
        impulses = np.zeros(block.before.shape)
        for row, (body, pulled) in self._held.items():
            impulses[row, body] = pulled
        by_hand = self.ledger.work(block, impulses) if self._held else given.copy()
        self._held.clear()
        for row, push in self._pushes.items():
            block.before[row], given[row], rubbed[row] = push
        self._pushes.clear()
        self._book(block, given, by_hand, rubbed)
        self.base = states[-1].copy()
        return block

    def _book(self, block: Block, given: Floats, by_hand: Floats, rubbed: Floats) -> None:
        """Book a block and what was pushed during it, and sample it for the history."""
        ledger = self.ledger
        had = ledger.given, ledger.contacts, ledger.friction, ledger.rods
        across, along = ledger.settle(block, self.clock.size, by_hand)
        given = given + by_hand
        stopped = np.zeros(len(given))
        stopped[0], self._to_rods = self._to_rods, 0.0
        ledger.given += float(given.sum())
        ledger.friction += float(rubbed.sum())
        ledger.rods += float(stopped[0])
        every = max(1, round(_SAMPLE / self.clock.size))
        rows = slice((-block.first_step) % every, None, every)
        changes = (np.cumsum([given, across, along + rubbed, stopped], axis=1).T + had)[rows]
        self._remember(block.times[rows], block.states[rows], changes)

    def gave(self) -> None:
        """Something was changed from outside since ``base``: book the energy it brought as given."""
        had = self._energy()
        self.base = self.space.state()
        self.ledger.given += self._energy() - had
        self._to_rods = self.space.stopped_by_joints()

    def recast(self, gravity: tuple[float, float]) -> None:
        """Bodies came or went, or gravity changed: book the energy it brought as given."""
        had = self._energy()
        self.ledger.adopt(self.space.parts, gravity)
        self.base = self.space.state()
        self.ledger.given += self._energy() - had

    def push(
        self, hand: Hand | None, wheeled: list[Part], speeds: tuple[float, float], floor: Floor | None
    ) -> None:
        """Let hand, wheels and floor act before a step."""
        ledger, size, count = self.ledger, self.clock.size, len(self.recorder)
        if hand is not None:
            self._held[count] = self.space.index[hand.name], hand.pull(self.space.body(hand.name), size)
        if not wheeled and floor is None:
            return
        had = ledger.kinetic(self.space.state())
        work = 0.0
        for part in wheeled:
            if part.wheels is not None:
                pressing = floor.gravity if floor else _WEIGHT
                work += drive(self.space.body(part.name), part.wheels, speeds, pressing, size)
        if floor is not None:
            for part in self.space.parts:
                if not part.fixed and part.wheels is None:
                    gyration = math.sqrt(part.moment / part.mass) if math.isfinite(part.moment) else 0.0
                    brake(self.space.body(part.name), floor, size, gyration)
        state = self.space.state()
        self._pushes[count] = state[:, 3:], work, work - (ledger.kinetic(state) - had)

    def _energy(self) -> float:
        return self.ledger.kinetic(self.base) + self.ledger.potential(self.base)

    def _remember(self, times: Floats, states: Floats, changes: Floats) -> None:
        """Put samples into the history.

        Args:
            times: (k,), in s.
            states: (k, n, 6).
            changes: given, and lost in contacts, to friction and in rods until then; (k, 4), in J.
        """
        if not len(times):
            return
        table = self.ledger.table(states)
        rest = self.ledger.start + changes[:, 0] - table[:, :2].sum(axis=1) - changes[:, 1:].sum(axis=1)
        rows = np.column_stack([times, table[:, :2], changes[:, 1:], rest, table[:, 2:]])
        self._history.extend(rows.tolist())
