"""A small physics engine: gravity, forces, contacts, one fixed step, and a record of it all.

Every step has three parts: let everything fly; where surfaces met on the way, go back to that instant and let
them strike; hold up what lies on something. Sample i belongs to the time ``i h``, never to a sum of steps.

States may hold many runs at once (leading axes), which then go forward together:

    >>> from course.physics.body import Body
    >>> from course.physics.state import RigidBodyState
    >>> heights = [[0.0, 0.0, z] for z in (1.0, 5.0, 10.0)]
    >>> engine = Simulator([Body(1.0, RigidBodyState.of(heights))], h=0.01)
    >>> engine.run(2.0).ground_time[0].round(3).tolist()
    [0.452, 1.01, 1.428]
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from course.physics.contact import Contact, Plane, Surface, meet, meet_plane, part, slip, strike
from course.physics.integrators import State, Stepper, VelocityVerlet
from course.physics.interpolation import falling_root
from course.physics.rotation import Spin, SplitRotation, kinetic_energy, turn_back
from course.physics.state import RigidBodyState

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    from course.physics.body import Body

    Array = NDArray[np.float64]
    #: Adds forces to bodies, given the time (s) and all of them: ``law(t, bodies)``.
    ForceLaw = Callable[[Any, Sequence[Body]], None]

__all__ = ["Recording", "Simulator", "step_count"]

_IMPACTS_A_STEP = 8  # blows that one step resolves one by one; what is left is held up at its end
_SUPPORT_ROUNDS = 10  # how often a step goes over its resting contacts, so that stacks stand
_SLACK = 1e-12  # m: overlap that round-off leaves, not worth another round
_REST = 1.5  # speeds below this many g h are what gravity adds in one step, no blow


def step_count(duration: float, h: float) -> int:
    """How many steps of h (s) make up a duration (s).

    Raises:
        ValueError: either is not a positive finite number, or the step does not divide the duration; the
            message names the nearest values that would do.
    """
    if not 0 < h < math.inf:
        raise ValueError(f"A step must be a positive number of seconds, not {h:g}.")
    if not 0 <= duration < math.inf:
        raise ValueError(f"A duration must be 0 or a positive number of seconds, not {duration:g}.")
    ratio = duration / h
    n = round(ratio)
    if abs(ratio - n) <= 1e-6:
        return n
    counts = [k for k in (math.floor(ratio), math.floor(ratio) + 1) if k > 0]
    durations = [_short(k * h) or f"{k * h:.17g}" for k in counts]
    steps = [_short(duration / k) or f"{duration:.17g}/{k}" for k in reversed(counts)]
    raise ValueError(
        f"A step of {h:g} s does not divide {duration:g} s: it takes {ratio:.6g} of them. "
        f"Near it, {' s and '.join(durations)} s would do, or a step of {' s or '.join(steps)} s."
    )


def _short(value: float) -> str:
    """A number in six digits if that is all there is to it; otherwise nothing, for it would not divide."""
    text = f"{value:.6g}"
    return text if abs(float(text) - value) <= 1e-12 * value else ""


@dataclass(frozen=True, eq=False)
class Recording:
    """A run: n + 1 samples, the start included, of B bodies; ``...`` are the leading axes of their states.

    Attributes:
        t: shape (n + 1,), s.
        position, velocity: shape (n + 1, B, ..., 3), m and m/s.
        orientation: shape (n + 1, B, ..., 4). angular_velocity: (n + 1, B, ..., 3), rad/s, body axes.
        mass: shape (B,), kg. inertia: shape (B, 3), kg m². gravity: m/s².
        first_contact: pairs of body numbers (None is the ground) -> the time they first met, s, shape (...);
            NaN where they did not.
    """

    t: Array
    position: Array
    velocity: Array
    orientation: Array
    angular_velocity: Array
    mass: Array
    inertia: Array
    gravity: float
    first_contact: dict[tuple[int, int | None], Array] = field(default_factory=dict)

    @property
    def ground_time(self) -> Array:
        """When each body first met the ground, s, shape (B, ...); NaN where it did not, or there is none."""
        never = np.full(self.position.shape[2:-1], np.nan)
        return np.stack([self.first_contact.get((i, None), never) for i in range(self.mass.size)])

    def momentum(self) -> Array:
        """Total momentum, kg m/s, shape (n + 1, ..., 3)."""
        return np.asarray(np.tensordot(self.mass, self.velocity, axes=(0, 1)))

    def energy(self) -> Array:
        """Total energy, motion, rotation and height together, J, shape (n + 1, ...)."""
        total = np.zeros(self.position.shape[:1] + self.position.shape[2:-1])
        for i, mass in enumerate(self.mass):
            total += 0.5 * mass * np.sum(self.velocity[:, i] ** 2, axis=-1)
            total += mass * self.gravity * self.position[:, i, ..., 2]
            if np.all(np.isfinite(self.inertia[i])):
                total += kinetic_energy(self.inertia[i], self.angular_velocity[:, i])
        return total


class _Pair(NamedTuple):
    """Two bodies by number; the second is None for the ground."""

    a: int
    b: int | None


class Simulator:
    """Bodies, gravity, force laws, ground and contacts, advanced by one fixed step.

    Args:
        bodies: their states must have leading axes that fit together.
        h: the step, s.
        gravity: m/s², along -z.
        ground: the plane things fall on; None for none.
        surface: restitution and friction of every contact.
        stepper: the method that integrates the flight.
        laws: called as ``law(t, bodies)`` whenever forces are needed, to add theirs. While the method looks
            ahead, the states of the bodies are the looked-at ones.
        contacts: False lets bodies pass through each other; the ground stays.

    Raises:
        ValueError: the step is not positive, there is no body, or the leading axes do not fit together.
    """

    def __init__(
        self,
        bodies: Sequence[Body],
        *,
        h: float,
        gravity: float = 9.81,
        ground: Plane | None = Plane(),  # noqa: B008 - frozen
        surface: Surface = Surface(),  # noqa: B008 - frozen
        stepper: Stepper = VelocityVerlet(),  # noqa: B008 - frozen
        laws: Sequence[ForceLaw] = (),
        contacts: bool = True,
    ) -> None:
        if not bodies:
            raise ValueError("A simulation needs a body.")
        step_count(0.0, h)
        self.bodies = list(bodies)
        self.h, self.gravity = float(h), float(gravity)
        self.ground, self.surface, self.stepper, self.laws = ground, surface, stepper, list(laws)
        shapes = [body.state.batch for body in bodies]
        self.batch = np.broadcast_shapes(*shapes, np.shape(surface.restitution), np.shape(surface.friction))
        for body in self.bodies:
            body.state = body.state.broadcast(self.batch)
        count = len(bodies)
        self._pairs = [_Pair(i, j) for i in range(count) for j in range(i + 1, count) if contacts]
        self._pairs += [_Pair(i, None) for i in range(count) if ground is not None]
        self._first: dict[tuple[int, int | None], Array] = {
            (pair.a, pair.b): np.full(self.batch, np.nan) for pair in self._pairs
        }
        self._steps = 0

    @property
    def time(self) -> float:
        """Now, s: the number of steps times the step."""
        return self._steps * self.h

    def run(self, duration: float) -> Recording:
        """Go on for a duration (s) and give every sample, the present one first.

        Raises:
            ValueError: the step does not divide the duration.
        """
        n = step_count(duration, self.h)
        t: Array = (self._steps + np.arange(n + 1, dtype=np.float64)) * self.h
        samples = [self._sample()]
        for _ in range(n):
            self.step()
            samples.append(self._sample())
        position, velocity, orientation, spin = (np.stack(column) for column in zip(*samples, strict=True))
        mass = np.array([body.mass for body in self.bodies])
        inertia = np.stack([body.inertia for body in self.bodies])
        first = {pair: times.copy() for pair, times in self._first.items()}
        return Recording(t, position, velocity, orientation, spin, mass, inertia, self.gravity, first)

    def step(self) -> None:
        """One step: fly, strike where surfaces met on the way, hold up what rests."""
        left = np.full(self.batch, self.h)
        for _ in range(_IMPACTS_A_STEP):
            before = self._states()
            self._fly(left)
            share, which = self._first_meeting(before, left)
            met = share <= 1.0
            if not np.any(met):
                left = np.zeros(self.batch)
                break
            span = np.where(met, share, 1.0) * left
            self._restore(before)
            self._fly(span)
            left = left - span
            for k, pair in enumerate(self._pairs):
                self._blow(pair, met & (which == k), self.time + self.h - left)
        if np.any(left > 0):
            self._fly(left)
        self._hold_up()
        self._steps += 1

    # -- flight ----------------------------------------------------------------------------------------

    def _accelerations(self, t: Any, q: Array, v: Array) -> Array:
        """What the forces do to every body at these positions and velocities; shape (B, ..., 3)."""
        for body, position, velocity in zip(self.bodies, q, v, strict=True):
            body.state = RigidBodyState(
                position, velocity, body.state.orientation, body.state.angular_velocity
            )
            body.clear()
        for law in self.laws:
            law(t, self.bodies)
        a = np.empty_like(q)
        for i, body in enumerate(self.bodies):
            a[i] = body.acceleration()
            a[i, ..., 2] -= self.gravity if math.isfinite(body.mass) else 0.0
        return a

    def _fly(self, span: Array) -> None:
        """Advance every body by ``span`` (s, one for every run) as if nothing were in the way."""
        h: Any = span[..., None]
        q = np.stack([body.state.position for body in self.bodies])
        v = np.stack([body.state.velocity for body in self.bodies])
        spins = [self._turned(body, h) if body.spins else None for body in self.bodies]
        after = self.stepper.advance(_Accelerations(self), State(self.time, q, v), h)
        for body, spin, position, velocity in zip(self.bodies, spins, after.q, after.v, strict=True):
            turned = spin or Spin(body.state.orientation, body.state.angular_velocity)
            body.state = RigidBodyState(position, velocity, *turned)

    def _turned(self, body: Body, h: Any) -> Spin:
        """A body's rotation after h, under the torque that its force laws gave it last."""
        spin = Spin(body.state.orientation, body.state.angular_velocity)
        torque = turn_back(body.state.orientation, np.broadcast_to(body.torque, (*self.batch, 3)))
        return SplitRotation().advance(body.inertia, spin, torque, h)

    # -- contact ---------------------------------------------------------------------------------------

    def _contact(self, pair: _Pair) -> tuple[Contact, Body, Body | None]:
        a = self.bodies[pair.a]
        if pair.b is None:
            assert self.ground is not None
            return meet_plane(a, self.ground), a, None
        b = self.bodies[pair.b]
        return meet(a, b), a, b

    def _first_meeting(self, before: list[RigidBodyState], span: Array) -> tuple[Array, Array]:
        """Which pair met first on the way from ``before`` to now, and after which share of ``span``.

        Returns:
            The share, inf where none met, and the number of the pair; both of shape (...).
        """
        share = np.full(self.batch, np.inf)
        which = np.full(self.batch, -1)
        for k, pair in enumerate(self._pairs):
            when = (
                self._meeting_with_ground(pair, before, span) if pair.b is None else self._sweep(pair, before)
            )
            sooner = when < share
            share, which = np.where(sooner, when, share), np.where(sooner, k, which)
        return share, which

    def _meeting_with_ground(self, pair: _Pair, before: list[RigidBodyState], span: Array) -> Array:
        """Where the gap, a cubic in time, falls through 0; arrivals too slow to bounce do not count."""
        contact, body, _ = self._contact(pair)
        arriving = body.state.velocity @ -contact.normal[(0,) * len(self.batch)]
        fast = (contact.gap < 0) & (-arriving > _REST * self.gravity * self.h)
        if not np.any(fast):
            return np.full(self.batch, np.inf)
        now = body.state
        body.state = before[pair.a]
        old, _, _ = self._contact(pair)
        leaving = body.state.velocity @ -contact.normal[(0,) * len(self.batch)]
        body.state = now
        share = falling_root(old.gap, contact.gap, leaving * span, arriving * span)
        return np.where(fast, share, np.inf)

    def _sweep(self, pair: _Pair, before: list[RigidBodyState]) -> Array:
        """Where two spheres first touch if each moves straight from its old place to its new one.

        A sphere that passed right through the other within the step is caught too.
        """
        a, b = self.bodies[pair.a], self.bodies[int(pair.b or 0)]
        old = before[int(pair.b or 0)].position - before[pair.a].position
        new = b.state.position - a.state.position
        move = new - old
        reach = a.radius + b.radius
        # |old + s move|² = reach², the smaller root; closing where old . move < 0.
        half = np.sum(old * move, axis=-1)
        square = np.sum(move * move, axis=-1)
        room = np.sum(old * old, axis=-1) - reach**2
        inside = half * half - square * room
        closing = (half < 0) & (inside >= 0)
        safe = np.where(closing, np.sqrt(np.maximum(inside, 0.0)) - half, 1.0)
        return np.where(closing, np.maximum(room, 0.0) / safe, np.inf)

    def _blow(self, pair: _Pair, where: Array, now: Array) -> None:
        """Let a pair strike in the runs where it met, and note the first time."""
        if not np.any(where):
            return
        contact, a, b = self._contact(pair)
        strike(contact, a, b, self.surface, where)
        part(contact, a, b, where)
        self._note(pair, where, now)

    def _hold_up(self) -> None:
        """Take approach and overlap out of whatever lies on something; friction acts as it presses."""
        soft = Surface(0.0, self.surface.friction)
        for _ in range(_SUPPORT_ROUNDS):
            busy = False
            for pair in self._pairs:
                contact, a, b = self._contact(pair)
                approaching = np.sum(slip(contact, a, b) * contact.normal, axis=-1) < 0
                where = (contact.gap <= 0) & approaching
                if np.any(where):
                    busy = True
                    strike(contact, a, b, soft, where)
                    self._note(pair, where, np.full(self.batch, self.time + self.h))
                deep = contact.gap < -_SLACK
                if np.any(deep):
                    busy = True
                    part(contact, a, b, deep)
            if not busy:
                break

    def _note(self, pair: _Pair, where: Array, now: Array) -> None:
        first = self._first[pair.a, pair.b]
        fresh = where & np.isnan(first)
        first[fresh] = now[fresh]

    # -- states ----------------------------------------------------------------------------------------

    def _states(self) -> list[RigidBodyState]:
        return [body.state for body in self.bodies]

    def _restore(self, states: list[RigidBodyState]) -> None:
        for body, state in zip(self.bodies, states, strict=True):
            body.state = state

    def _sample(self) -> tuple[Array, Array, Array, Array]:
        states = self._states()
        return (
            np.stack([state.position for state in states]),
            np.stack([state.velocity for state in states]),
            np.stack([state.orientation for state in states]),
            np.stack([state.angular_velocity for state in states]),
        )


@dataclass(frozen=True, slots=True)
class _Accelerations:
    """The engine's forces in the form that steppers take."""

    engine: Simulator

    def __call__(self, t: float, q: Any, v: Any) -> Array:
        return self.engine._accelerations(t, q, v)

    def params(self) -> dict[str, Any]:
        return {"h": self.engine.h, "gravity": self.engine.gravity}
