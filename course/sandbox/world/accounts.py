"""The accounts of a running world: where energy came from and where it went."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import msgspec
import numpy as np
import pymunk

from course.sandbox.scene.model import Floor, Part, Wheels
from course.sandbox.world.engine import Block, Floats, Ledger, Recorder, Space

# ---
# Pushes from outside the contacts: a hand that drags, wheels that drive, a floor that rubs.
#
# Wheels and floor are impulses before a step, sized for that step. A hand is a force inside it, because rods
# and contacts answer it there. So the account of energy knows exactly what each did.


#: How fast a hand closes the gap to where it is, in 1/s, unless the step is too long for that.
_EAGERNESS = 20.0
#: The strongest pull, as an acceleration of what is held, in m/s²: a hand does not go through walls.
_STRENGTH = 500.0
#: How fast turning dies down while something is held, in 1/s.
_CALM = 4.0


@dataclass(slots=True)
class Hand:
    """Holds a body at a point and pulls that point to where the pointer is.

    Attributes:
        name: of the body.
        anchor: in the body's frame, in m.
        x, y: where the pointer is, in m.
    """

    name: str
    anchor: tuple[float, float]
    x: float
    y: float

    def pull(self, body: pymunk.Body, step: float) -> tuple[float, float, float]:
        """Put the hand's force on the body for one step, and return its impulses: in N s, N s and N m s."""
        place = body.local_to_world(self.anchor)
        velocity = body.velocity_at_local_point(self.anchor)
        eager = min(_EAGERNESS, 0.5 / step)
        rx, ry = place.x - body.position.x, place.y - body.position.y
        inertia = 0.0 if math.isinf(body.moment) else (rx * rx + ry * ry) / body.moment
        heavy = 1.0 / (1.0 / body.mass + inertia)
        jx = heavy * ((self.x - place.x) * eager - velocity.x) / 2
        jy = heavy * ((self.y - place.y) * eager - velocity.y) / 2
        size, most = math.hypot(jx, jy), body.mass * _STRENGTH * step
        if size > most:
            jx, jy = jx * most / size, jy * most / size
        turn = rx * jy - ry * jx
        if not math.isinf(body.moment):
            turn -= body.moment * body.angular_velocity * (1.0 - math.exp(-_CALM * step))
        body.force += jx / step, jy / step
        body.torque += turn / step
        return jx, jy, turn


def brake(body: pymunk.Body, floor: Floor, step: float, gyration: float) -> None:
    """Let the floor rub for one step: Coulomb's friction on the sliding and the turning.

    Args:
        gyration: radius at which the body's weight rubs when it turns, in m.
    """
    speed = body.velocity.length
    change = floor.friction * floor.gravity * step
    if speed > 0.0:
        body.velocity = body.velocity * max(0.0, 1.0 - change / speed)
    spin = body.angular_velocity
    if spin != 0.0 and not math.isinf(body.moment):
        slower = change * body.mass * gyration / body.moment
        body.angular_velocity = math.copysign(max(0.0, abs(spin) - slower), spin)


def drive(
    body: pymunk.Body, wheels: Wheels, speeds: tuple[float, float], gravity: float, step: float
) -> float:
    """Let two wheels roll for one step; neither slips sideways before its grip is used up.

    Args:
        speeds: of the left and the right rim, in m/s.
        gravity: presses the wheels onto the floor, in m/s².

    Returns:
        the work of the motors in J; what it did not turn into motion was rubbed off.
    """
    work = 0.0
    most = wheels.grip * body.mass * gravity * step / 2
    for side, speed in zip((0.5, -0.5), speeds, strict=True):
        ahead = body.rotation_vector
        place = body.local_to_world((0.0, side * wheels.track))
        slip = ahead * speed - body.velocity_at_world_point(place)
        # Half the body's mass rests on each wheel; a wheel that took all of it would fight the other.
        push = slip * (body.mass / 2)
        if push.length > most:
            push = push * (most / push.length)
        body.apply_impulse_at_world_point(push, place)
        work += push.dot(ahead) * speed
    return work


# ---
# Events that a world reports: contacts, bodies that stop or leave, and the user's actions.


class Event(msgspec.Struct, frozen=True, kw_only=True, omit_defaults=True):
    """One thing that happened.

    Attributes:
        kind: "contact", "rest" (a body came to a stop), "gone" (it left the world), or "input" (the user
            did something).
        t: in s; step: number of the step, the first is 1.
        a, b: names of the bodies; ``a`` moves, ``b`` is "" unless it is a contact, or a copy of it.
        x, y: where, in m.
        nx, ny: unit normal of a contact, from ``a`` to ``b``.
        approach, leave: speed along the normal before and after, in m/s; both positive for a bounce. A
            contact in which they stay together leaves at about 0. One whose approach is below 0 was found too
            late: the bodies were already inside each other.
        slip: speed along the surface before, in m/s.
        impulse: size of the impulse of the first step of contact, in N s.
        before, after: kinetic energy of the two together, in J.
        shared: both of them can move.
        minor: too soft to be worth a sentence.
        text: what was done, for "input".
    """

    kind: str
    t: float
    step: int
    a: str = ""
    b: str = ""
    x: float = 0.0
    y: float = 0.0
    nx: float = 0.0
    ny: float = 0.0
    approach: float = 0.0
    leave: float | None = None
    slip: float = 0.0
    impulse: float | None = None
    before: float | None = None
    after: float | None = None
    shared: bool = False
    minor: bool = False
    text: str = ""

    @property
    def lost(self) -> float | None:
        """The share of the kinetic energy that this contact took, 0 to 1; None where it is not known."""
        if self.before is None or self.after is None or self.before <= 0.0:
            return None
        return 1.0 - self.after / self.before


#: Contacts softer than this, in m/s, belong to resting and rolling.
MINOR = 0.05


def contact_events(block: Block, parts: Sequence[Part], ledger: Ledger) -> list[Event]:
    """One event for each pair that began to touch in these steps, in a fixed order.

    The numbers of all of them are worked out at once.
    """
    contacts = block.contacts
    found = np.flatnonzero(contacts.first)
    if not len(found):
        return []
    k, a, b = contacts.row[found], contacts.a[found], contacts.b[found]
    normal, point = contacts.normal[:, found].T, contacts.point[:, found].T
    # A sentence about the two begins with a moving body before a fixed one, then by name.
    ranks = [(part.fixed, part.name) for part in parts]
    swap = np.array([ranks[i] > ranks[j] for i, j in zip(a.tolist(), b.tolist(), strict=True)])
    a, b = np.where(swap, b, a), np.where(swap, a, b)
    normal = np.where(swap[:, None], -normal, normal)
    rows = np.stack([block.before[k, a], block.before[k, b], block.states[k, a, 3:], block.states[k, b, 3:]])
    # The engine moves bodies first, so it looks for contacts where they are after the step.
    arm_a, arm_b = point - block.states[k, a, :2], point - block.states[k, b, :2]
    came = _relative(rows[0], rows[1], arm_a, arm_b)
    left = _relative(rows[2], rows[3], arm_a, arm_b)
    nx, ny = normal.T
    weights = [np.stack([ledger.mass[i], ledger.mass[i], ledger.inertia[i]], axis=1) / 2 for i in (a, b)]
    energies = [
        (weights[0] * rows[i] ** 2).sum(axis=1) + (weights[1] * rows[i + 1] ** 2).sum(axis=1) for i in (0, 2)
    ]
    numbers = {
        "x": point[:, 0],
        "y": point[:, 1],
        "nx": nx,
        "ny": ny,
        "approach": -(came[:, 0] * nx + came[:, 1] * ny),
        "leave": left[:, 0] * nx + left[:, 1] * ny,
        "slip": np.abs(came[:, 1] * nx - came[:, 0] * ny),
        "impulse": np.hypot(*contacts.impulse[:, found]),
        "before": energies[0],
        "after": energies[1],
    }
    events = []
    columns = (column.tolist() for column in (k, a, b, *numbers.values()))
    for row, one, other, *values in zip(*columns, strict=True):
        told = dict(zip(numbers, values, strict=True))
        minor, shared = abs(told["approach"]) < MINOR, not parts[other].fixed
        t, step = float(block.times[row]), block.first_step + row
        names = {"a": parts[one].name, "b": parts[other].name}
        events.append(Event(kind="contact", t=t, step=step, minor=minor, shared=shared, **names, **told))
    # The engine lists contacts by memory address; names make the order the same in every run.
    return sorted(events, key=lambda event: (event.step, event.a, event.b))


def _relative(row_a: Floats, row_b: Floats, arm_a: Floats, arm_b: Floats) -> Floats:
    """Velocities of ``b`` against ``a`` at points of contact, (m, 2), in m/s.

    Args:
        row_a, row_b: vx, vy and spin, (m, 3).
        arm_a, arm_b: from the centres to the points, (m, 2).
    """
    vx = row_b[:, 0] - row_b[:, 2] * arm_b[:, 1] - row_a[:, 0] + row_a[:, 2] * arm_a[:, 1]
    vy = row_b[:, 1] + row_b[:, 2] * arm_b[:, 0] - row_a[:, 1] - row_a[:, 2] * arm_a[:, 0]
    return np.column_stack([vx, vy])


# ---
# The accounts themselves.


class Receipt(msgspec.Struct, frozen=True, kw_only=True):
    """Where the energy is. All in J; the parts always add up: ``start + given`` equals all the others.

    Attributes:
        start: the energy at time 0.
        given: added since by hands, motors, spawned bodies and changes of gravity.
        kinetic, potential: now; potential energy is zero at y = 0 (x = 0).
        contacts: lost across contacts, along their normals.
        friction: lost along surfaces, and to the floor of a scene seen from above.
        rods: lost in joints: a body that is thrown against them, and what they correct.
        residual: missing without a known loss. Below zero: the solver made energy.
        integrator: the part of ``residual`` that comes from how bodies are moved. They are moved before they
            are accelerated, which is half a step's worth of gravity's power, -m g (v - v at the start) h/2,
            and comes back with the velocity; and bodies inside each other are moved apart, up or down.
    """

    start: float
    given: float
    kinetic: float
    potential: float
    contacts: float
    friction: float
    rods: float
    residual: float
    integrator: float


#: States of bodies that are booked together, and steps: more would not fit the cache.
_STATES, _STEPS = 3200, 256
#: The gravity that presses wheels onto the ground of a scene without a floor, in m/s².
_WEIGHT = 9.81


@dataclass(slots=True)
class Clock:
    """Time as a number of steps since the step size was last changed: never a running sum.

    Attributes:
        since, at: the time in s and the number of steps when the size was last changed.
        size: of a step, in s.
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
        gravity: in m/s².
    """

    def __init__(self, space: Space, gravity: tuple[float, float], clock: Clock) -> None:
        self.space = space
        self.clock = clock
        self.recorder = Recorder(space)
        self.ledger = Ledger(space.parts, gravity)
        #: The state that the next step starts from; (n, 6).
        self.base = space.state()
        self.ledger.start = self._energy()
        #: By row of the block to come: velocities after a push, energy given by it, energy rubbed off.
        self._pushes: dict[int, tuple[Floats, float, float]] = {}
        #: By row of the block to come: the body that a hand held, and the impulses of the hand.
        self._held: dict[int, tuple[int, tuple[float, float, float]]] = {}
        self._ties = space.ties()

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

    # -- booking ---------------------------------------------------------------------------------

    @property
    def full(self) -> bool:
        """It is time to ``close``."""
        return len(self.recorder) >= min(_STEPS, _STATES // (len(self.base) + 1) + 1)

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
            start=self.base[:, :2],
            states=states,
            contacts=contacts,
        )
        given, rubbed = np.zeros(count), np.zeros(count)
        for row, push in self._pushes.items():
            block.before[row], given[row], rubbed[row] = push
        self._pushes.clear()
        impulses = None
        if self._held:
            impulses = np.zeros(block.before.shape)
            for row, (body, pulled) in self._held.items():
                impulses[row, body] = pulled
            self._held.clear()
            given += self.ledger.work(block, impulses)
        resized = first == self.clock.at + 1 > 1
        self.ledger.settle(block, self.clock.size, impulses, self._ties, resized=resized)
        self.ledger.given += float(given.sum())
        self.ledger.friction += float(rubbed.sum())
        self.base = states[-1].copy()
        return block

    def resume(self, sums: tuple[float, ...]) -> None:
        """Go on with these sums after steps of which nothing was kept."""
        self._pushes.clear()
        self._held.clear()
        self.ledger.sums, self.base = sums, self.space.state()

    def recast(self, gravity: tuple[float, float]) -> None:
        """Bodies came, went or were changed since ``base``, or gravity was: book what it brought as given."""
        had = self._energy()
        self.ledger.adopt(self.space.parts, gravity)
        self._ties = self.space.ties()
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
