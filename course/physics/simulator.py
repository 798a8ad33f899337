"""A small physics engine: gravity, forces, contacts, one fixed step, and a record of it all.

A step first finds which surfaces touch and what velocities their contacts allow, and only then moves the
bodies: velocity before position. A body at rest on another is carried by forces that stay constant over the
step, so it neither sinks nor creeps, whatever the integrator. Where surfaces meet during the step, it goes
back to that instant, lets them collide, and continues. Sample i belongs to the time ``i h``, never to a sum
of steps.

States may hold many runs at once (leading axes), which are then advanced together:

    >>> from course.physics.body import Body
    >>> from course.physics.state import RigidBodyState
    >>> heights = [[0.0, 0.0, z] for z in (1.0, 5.0, 10.0)]
    >>> engine = Simulator([Body(1.0, RigidBodyState.of(heights))], h=0.01)
    >>> engine.run(2.0).ground_time[0].round(3).tolist()
    [0.452, 1.01, 1.428]
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any, cast

import numpy as np

from course.physics.body import Body
from course.physics.contact import Plane, Surface
from course.physics.contact.impulses import Flags, Impulses, Motion, normal_speed, solve
from course.physics.contact.pairs import Pairs, in_any_run
from course.physics.integrators import State, Stepper, VelocityVerlet
from course.physics.rotation import ByMomentum, ByQuaternion, Spin, kinetic_energy, turn, turn_back
from course.physics.state import Array, RigidBodyState

ForceLaw = Callable[[Any, Sequence[Body]], None]


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


# A step goes back to this many instants at which surfaces meet; what meets after that overlaps a little.
_INSTANTS = 8
_BLOWS = 64  # impacts that pass from pair to pair at one instant, as along a row of balls
_REST = 1.5  # speeds below this many g h are what gravity adds in one step, no impact: they do not bounce
_STILL = 0.01  # a speed below this share of g h is rest: the forces of the next step end it
_NEAR = 1e-3  # a gap below this share of g h² is none
_PATIENCE = (5, 10)  # contacts give way in so many of so many steps: the solver will not get there
_ROUND_OFF = 1e-12  # m and m/s: what counts as zero without gravity


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
    """The number in six digits if that is exact; otherwise empty, as the rounded one would not divide."""
    text = f"{value:.6g}"
    return text if abs(float(text) - value) <= 1e-12 * value else ""


class Simulator:
    """Bodies, gravity, force laws, ground and contacts, advanced by one fixed step.

    Args:
        bodies: their states must have leading axes that fit together.
        h: the step, s.
        gravity: m/s², along -z.
        ground: the plane things fall on; None for none.
        surface: restitution and friction of every contact. What meets at less than 1.5 g h does not bounce.
        stepper: the method that integrates the motion.
        laws: called as ``law(t, bodies)`` whenever forces are needed, to add forces and torques. While the
            method looks ahead, the states of the bodies are the looked-at ones. The time t (s) is a number;
            with many runs at once, an array of shape (..., 1), for each may be at another instant. Forces and
            torques act to the order of ``stepper``; a torque turns a body to order 4 at most.
        contacts: False lets bodies pass through each other; the ground stays.

    Raises:
        ValueError: the step is not positive, gravity is not finite, there is no body, or the leading axes do
            not fit together; in ``step``, that a body touches something which is no sphere by its inertia,
            that a law's force is not a finite number, or that a body is too heavy for what carries it.
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
        if not math.isfinite(gravity):
            raise ValueError(f"Gravity must be a finite number of m/s², not {gravity:g}.")
        self.bodies = list(bodies)
        self.h, self.gravity = float(h), float(gravity)
        self.ground, self.surface, self.stepper, self.laws = ground, surface, stepper, list(laws)
        shapes = [body.state.batch for body in bodies]
        self.batch = np.broadcast_shapes(*shapes, np.shape(surface.restitution), np.shape(surface.friction))
        for body in self.bodies:
            body.state = body.state.broadcast(self.batch)
        self._steps = 0
        self._pairs = Pairs(self.bodies, ground, self.batch, spheres=contacts)
        falls = np.array([self.gravity if math.isfinite(body.mass) else 0.0 for body in bodies])
        self._falling = self._column(falls) * np.array([0.0, 0.0, -1.0])
        self._spinning = [i for i, body in enumerate(bodies) if body.spins]
        inertia = np.array([bodies[i].inertia for i in self._spinning])
        self._inertia: Array = inertia.reshape(-1, *([1] * len(self.batch)), 3)
        #: m/s and m: slower is at rest, nearer touches.
        self._still = max(_STILL * abs(self.gravity) * self.h, _ROUND_OFF)
        self._near = max(_NEAR * abs(self.gravity) * self.h**2, _ROUND_OFF)
        #: What resting contacts add: accelerations, m/s², and angular accelerations, rad/s², world axes.
        self._held = self._held_spin = np.zeros((len(bodies), *self.batch, 3))
        shape = (len(self._pairs.numbers), *self.batch)
        #: Forces of the contacts in the last step, N: the solver's starting point in the next one.
        self._last = Impulses(np.zeros(shape), np.zeros((*shape, 3)))
        self._met_at: Array = np.full(shape, np.nan)
        #: Numbers of the last steps in which contacts gave way.
        self._gave_way: set[int] = set()

    def _column(self, values: Array) -> Array:
        """One number a body, ready to multiply vectors of shape (B, ..., 3)."""
        return values.reshape(-1, *([1] * len(self.batch)), 1)

    @property
    def time(self) -> float:
        """Now, s: the number of steps times the step."""
        return self._steps * self.h

    def run(self, duration: float) -> Recording:
        """Run for a duration (s) and return every sample, the present one first.

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
        inertia = np.array([body.inertia for body in self.bodies])
        ground = len(self.bodies)
        first = {
            (i, None if j == ground else j): self._met_at[k].copy()
            for k, (i, j) in enumerate(self._pairs.numbers)
        }
        return Recording(t, position, velocity, orientation, spin, mass, inertia, self.gravity, first)

    def step(self) -> None:
        """One step, from one meeting of surfaces to the next, with the contacts before the motion."""
        left = np.full(self.batch, self.h)
        met = np.zeros_like(self._met_at, dtype=bool)
        for instant in range(_INSTANTS + 1):
            start = self._pairs.now()
            touching = (met | (start.gap <= self._near)) & (left > 0)
            now = self.time + self.h - left
            self._collide(start.normal, touching, now)
            resting = self._support(start.normal, touching, left, now)
            start = start._replace(velocity=np.array([body.state.velocity for body in self.bodies]))
            before = self._states()
            self._fly(left, now)
            if instant == _INSTANTS:
                break
            share = self._pairs.meetings(start, self._pairs.now(), left, self._near, resting)
            soonest = np.min(share, axis=0, initial=np.inf)
            met = share <= np.minimum(soonest, 1.0)
            if not np.any(met):
                break
            self._restore(before)
            span = np.where(soonest <= 1.0, soonest, 1.0) * left
            self._fly(span, now)
            left = left - span
            self._pairs.put_together(met)
        self._pairs.push_apart(self._near)
        self._steps += 1

    # -- motion ----------------------------------------------------------------------------------------

    def _fly(self, span: Array, now: Array) -> None:
        """Advance every body by ``span`` (s, one for every run) from ``now`` without further contacts."""
        flight = _Flight(self, now[..., None])
        flight.put(self.stepper.advance(flight, flight.start(), cast("float", span[..., None])))

    def _forces(self, t: Array) -> tuple[Array, Array]:
        """Accelerations and torques by gravity, laws and contacts on the bodies as they are now.

        Returns:
            m/s² and N m, in the world's axes, both of shape (B, ..., 3).
        """
        a: Array = self._falling + self._held
        torque = np.zeros_like(a)
        torque[self._spinning] = self._inertia * self._held_spin[self._spinning]
        if self.laws:
            for body in self.bodies:
                body.clear()
            for law in self.laws:
                law(t if self.batch else float(t[0]), self.bodies)
            for i, body in enumerate(self.bodies):
                a[i] += body.acceleration()
                torque[i] += body.torque if body.spins else 0.0
            if not (np.isfinite(a).all() and np.isfinite(torque).all()):
                self._blame(t)
        return a, torque

    def _blame(self, t: Array) -> None:
        """Say which law has given what is no force."""
        for law in self.laws:
            for body in self.bodies:
                body.clear()
            law(t if self.batch else float(t[0]), self.bodies)
            for number, body in enumerate(self.bodies):
                if not (np.isfinite(body.force).all() and np.isfinite(body.torque).all()):
                    raise ValueError(
                        f"The law {getattr(law, '__name__', law)!r} gives body {number} no finite force at"
                        f" t = {float(np.min(t)):g} s: {body.force.tolist()} N, {body.torque.tolist()} N m."
                    )

    # -- contact ---------------------------------------------------------------------------------------

    def _velocity(self) -> Array:
        """How fast all bodies move now, m/s, and the ground, which does not; shape (B + 1, ..., 3)."""
        velocity = np.zeros((len(self.bodies) + 1, *self.batch, 3))
        for i, body in enumerate(self.bodies):
            velocity[i] = body.state.velocity
        return velocity

    def _motion(self) -> Motion:
        """How all bodies and the ground move now."""
        velocity = self._velocity()
        rim = np.zeros_like(velocity)
        if self._spinning:
            states = [self.bodies[i].state for i in self._spinning]
            spin = turn(
                np.array([state.orientation for state in states]),
                np.array([state.angular_velocity for state in states]),
            )
            rim[self._spinning] = self._column(self._pairs.radius)[self._spinning] * spin
        return Motion(velocity, rim, self._pairs.give, self._pairs.spin_give)

    def _collide(self, normal: Array, touching: Flags, now: Array) -> None:
        """End all approach in contacts at once, with restitution where it is fast enough to bounce."""
        speed = normal_speed(self._pairs.ends, normal, self._velocity())
        if not (touching & (speed < -self._still)).any():
            return
        before = self._motion()
        motion = before.copy()
        e = np.asarray(self.surface.restitution)
        bounce = max(_REST * abs(self.gravity) * self.h, self._still)
        for _ in range(_BLOWS):
            fast = touching & (speed < -bounce) & (e > 0)
            if not np.any(fast):
                break
            self._solve(normal, motion, fast, now, target=-e * speed)
            speed = normal_speed(self._pairs.ends, normal, motion.velocity)
        if np.any(touching & (speed < -self._still)):
            self._solve(normal, motion, touching, now)
        velocity, spin = self._difference(motion, before)
        for i, body in enumerate(self.bodies):
            q, w = body.state.orientation, body.state.angular_velocity
            body.state = RigidBodyState(
                body.state.position, body.state.velocity + velocity[i], q, w + turn_back(q, spin[i])
            )

    def _support(self, normal: Array, touching: Flags, left: Array, now: Array) -> Flags:
        """Find the forces that keep touching bodies apart for the rest of the step.

        These are the forces that leave no approach at the end of the motion, given how it would end without
        them.

        Returns:
            Which pairs rest on each other, shape (P, ...).
        """
        self._held, self._held_spin = np.zeros_like(self._held), np.zeros_like(self._held_spin)
        speed = normal_speed(self._pairs.ends, normal, self._velocity())
        resting = touching & (speed <= self._still)
        if not np.any(resting):
            self._last = Impulses(np.zeros_like(self._last.push), np.zeros_like(self._last.rub))
            return resting
        start = self._states()
        self._fly(left, now)
        free = self._motion()
        motion = free.copy()
        self._restore(start)
        span = np.where(left > 0, left, 1.0)
        impulses = Impulses(self._last.push * span * resting, self._last.rub * (span * resting)[..., None])
        self._solve(normal, motion, resting, now, impulses)
        approach = np.where(resting, -normal_speed(self._pairs.ends, normal, motion.velocity), 0.0)
        if approach.max() > self._still:
            self._give_way(approach)
        self._last = Impulses(impulses.push / span, impulses.rub / span[..., None])
        velocity, spin = self._difference(motion, free)
        self._held, self._held_spin = velocity / span[..., None], spin / span[..., None]
        return resting

    def _give_way(self, approach: Array) -> None:
        """Bear it for some steps that contacts approach each other at these speeds (m/s), and then refuse.

        A body that carries a thousand times its mass gets its support a thousandth at a time: it would sink
        into what is below, and nobody would know.
        """
        most, of = _PATIENCE
        self._gave_way = {*(step for step in self._gave_way if step > self._steps - of), self._steps}
        if len(self._gave_way) < most:
            return
        pair = int(np.argmax(approach.reshape(len(approach), -1).max(axis=1)))
        known = dict(enumerate(f"body {k} ({body.mass:g} kg)" for k, body in enumerate(self.bodies)))
        light, heavy = sorted(self._pairs.numbers[pair], key=lambda k: self._pairs.give[k], reverse=True)
        into = known.get(heavy)
        what = f"{into} sinks into {known[light]}" if into else f"{known[light]} sinks into the ground"
        masses = [body.mass for body in self.bodies if math.isfinite(body.mass)]
        raise ValueError(
            f"At t = {self.time:g} s {what}: the solver cannot carry {max(masses):g} kg on {min(masses):g} kg"
            " in so many contacts. Make the masses more alike."
        )

    def _solve(
        self,
        normal: Array,
        motion: Motion,
        active: Flags,
        now: Array,
        impulses: Impulses | None = None,
        target: float | Array = 0.0,
    ) -> None:
        """Let the active contacts act on a motion, and note which pairs touched for the first time."""
        pairs, touched = self._pairs, in_any_run(active)
        if np.isnan(pairs.spin_give[[*pairs.first[touched], *pairs.second[touched]]]).any():
            raise ValueError("Contacts are between spheres: the three moments of inertia must be equal.")
        if impulses is None:
            impulses = Impulses(np.zeros(active.shape), np.zeros((*active.shape, 3)))
        solve(pairs.numbers, normal, motion, impulses, active, target, self.surface.friction)
        fresh = (impulses.push > 0) & np.isnan(self._met_at)
        self._met_at = np.where(fresh, now, self._met_at)

    def _difference(self, motion: Motion, before: Motion) -> tuple[Array, Array]:
        """Change of velocity, m/s, and of angular velocity, rad/s, world axes; both of shape (B, ..., 3)."""
        rim = (motion.rim - before.rim)[:-1]
        size = self._column(self._pairs.radius)[:-1]
        return (motion.velocity - before.velocity)[:-1], rim / np.where(size > 0, size, 1.0)

    # -- states ----------------------------------------------------------------------------------------

    def _states(self) -> list[RigidBodyState]:
        return [body.state for body in self.bodies]

    def _restore(self, states: list[RigidBodyState]) -> None:
        for body, state in zip(self.bodies, states, strict=True):
            body.state = state

    def _sample(self) -> list[Array]:
        states = self._states()
        names = ("position", "velocity", "orientation", "angular_velocity")
        return [np.array([getattr(state, name) for state in states]) for name in names]


class _Flight:
    """A motion between contacts, in the form that steppers take: positions and velocities of everything.

    To those of the centres come, for bodies that can turn, those of their rotation.
    """

    def __init__(self, engine: Simulator, start: Array) -> None:
        self._engine, self._t = engine, start
        states = engine._states()
        self._spins = [Spin(state.orientation, state.angular_velocity) for state in states]
        self._turns = engine._spinning
        if self._turns:
            q, w = (np.array([self._spins[i][part] for i in self._turns]) for part in (0, 1))
            # What any law twists is of the method's order; what turns freely keeps its momentum.
            form = ByQuaternion if engine.laws and engine.stepper.order > 2 else ByMomentum
            self._turning = form(engine._inertia, Spin(q, w))

    def start(self) -> State:
        """Where the motion begins; q and v have shape (B, ..., 3) or, with rotations, (B, ..., 6 or 7)."""
        states = self._engine._states()
        x = np.array([state.position for state in states])
        v = np.array([state.velocity for state in states])
        if self._turns:
            x, v = (self._joined(*parts) for parts in zip((x, v), self._turning.state(), strict=True))
        return State(cast("float", self._t), x, v)

    def _joined(self, of_centres: Array, of_rotations: Array) -> Array:
        rest = np.zeros((*of_centres.shape[:-1], of_rotations.shape[-1]))
        rest[self._turns] = of_rotations
        return np.concatenate([of_centres, rest], axis=-1)

    def put(self, state: State) -> None:
        """Give the bodies the states at some instant of the motion."""
        spins = self._spins
        if self._turns:
            turned = self._turning.spin(
                state.t - self._t, state.q[self._turns, ..., 3:], state.v[self._turns, ..., 3:]
            )
            spins = spins.copy()
            for k, i in enumerate(self._turns):
                spins[i] = Spin(turned.orientation[k], turned.angular_velocity[k])
        for body, x, v, spin in zip(self._engine.bodies, state.q, state.v, spins, strict=True):
            body.state = RigidBodyState(x[..., :3], v[..., :3], *spin)

    def __call__(self, t: Any, q: Any, v: Any) -> Array:
        """Accelerations of everything, of the shape of q."""
        if self._engine.laws:
            self.put(State(t, q, v))
        a, torque = self._engine._forces(t)
        if not self._turns:
            return a
        rotations = q[self._turns, ..., 3:], v[self._turns, ..., 3:]
        return self._joined(a, self._turning.rate(torque[self._turns], *rotations))
