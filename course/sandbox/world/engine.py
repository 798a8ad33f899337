"""The only module that knows pymunk: bodies made from parts, and states and contacts copied out of it."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TypeAlias, assert_never

import numpy as np
import pymunk
from numpy.typing import NDArray
from pymunk import batch

from course.sandbox.scene.model import Joint, Part

# ---
# The account of energy and momentum, kept in blocks of steps.
#
# A step of pymunk is: move every body by ``v h``; find the contacts; add ``g h`` to every velocity; change
# velocities by impulses at contacts and joints. From ``v0`` to ``v1`` a body gains ``(m g h + P)(v0 +
# v1)/2``, with ``P`` the sum of its impulses, and that is exact: gravity's part and that of the impulses are
# the two terms. A body that rests gains and loses nothing in this way of counting. Friction's share is known
# contact by contact: impulse along the surface times the mean of the sliding speed before and after.
#
# A Python callback in each contact would cost more than the physics. Instead, two calls that stay in C copy
# velocities and impulses after each step, and the arithmetic is done for many steps at once. That is safe:
# nothing changes them before the next step.


Floats: TypeAlias = NDArray[np.float64]
Ints: TypeAlias = NDArray[np.int64]


@dataclass(frozen=True, slots=True)
class Contacts:
    """All contacts of some steps.

    Attributes:
        row: which step of the block, 0 first, (n,).
        a, b: indices of the bodies, (n,).
        first: 1 where the two did not touch in the step before, (n,).
        impulse: on ``a``, in N s, (2, n).
        normal: from ``a`` to ``b``, (2, n).
        point, other: where it acts on ``a`` and where on ``b``, in m, (2, n); they differ by how deep the
            bodies are in each other. Of a contact along an edge it is the middle.
        half: half of the length of a contact along an edge, in m, (n,), 0 for a contact at a point; None
            where there is no edge at all.
    """

    row: Ints
    a: Ints
    b: Ints
    first: NDArray[np.uint64]
    impulse: Floats
    normal: Floats
    point: Floats
    other: Floats
    half: Floats | None


@dataclass(frozen=True, slots=True)
class Block:
    """A few consecutive steps.

    Attributes:
        first_step: number of the first of them.
        times: at their ends, in s, (k,).
        before: velocities and spin at the start of each step, (k, n, 3).
        start: where the bodies were before the first of the steps, (n, 2), in m.
        states: at the end of each, (k, n, 6): x, y, angle, vx, vy, spin. Like the contacts these are the
            engine's own memory: good until the next step, so copy what is to be kept.
    """

    first_step: int
    times: Floats
    before: Floats
    start: Floats
    states: Floats
    contacts: Contacts


class Ledger:
    """Sums of the losses, by place.

    Args:
        parts: the bodies, in the order of the rows of every state.
        gravity: in m/s².
    """

    def __init__(self, parts: Sequence[Part], gravity: tuple[float, float]) -> None:
        self.contacts = 0.0
        self.friction = 0.0
        self.rods = 0.0
        self.integrator = 0.0
        self.given = 0.0
        self.start = 0.0
        self.adopt(parts, gravity)

    @property
    def sums(self) -> tuple[float, ...]:
        """All that was booked so far, in J."""
        return self.contacts, self.friction, self.rods, self.integrator, self.given

    @sums.setter
    def sums(self, booked: tuple[float, ...]) -> None:
        self.contacts, self.friction, self.rods, self.integrator, self.given = booked

    def adopt(self, parts: Sequence[Part], gravity: tuple[float, float]) -> None:
        """Switch to another set of bodies, or another gravity; the sums stay."""
        finite = [p.moment if np.isfinite(p.moment) else 0.0 for p in parts]
        self.mass = np.array([p.mass for p in parts])
        self.inertia = np.array(finite)
        self.gravity = gravity
        self._inertias = np.column_stack([self.mass, self.mass, self.inertia])
        self._weights = self._inertias.ravel() / 2
        self._heights = np.column_stack([-self.mass * gravity[0], -self.mass * gravity[1]]).ravel()
        forces = [self.mass * gravity[0], self.mass * gravity[1], 0.0 * self.mass]
        self._weight_force = np.column_stack(forces).ravel()

    # -- of one state ----------------------------------------------------------------------------

    def kinetic(self, state: Floats) -> float:
        """In J; state (n, 6)."""
        v = state[:, 3:].ravel()
        return float((v * v) @ self._weights)

    def potential(self, state: Floats) -> float:
        """In J; state (n, 6)."""
        return float(state[:, :2].ravel() @ self._heights)

    def momentum(self, state: Floats) -> tuple[float, float, float]:
        """Along x and y in kg m/s, and angular about the origin in kg m²/s; state (n, 6)."""
        x, y, _, vx, vy, spin = state.T
        angular = self.mass @ (x * vy - y * vx) + self.inertia @ spin
        return float(self.mass @ vx), float(self.mass @ vy), float(angular)

    # -- of many steps ---------------------------------------------------------------------------

    def settle(
        self, block: Block, step: float, given: Floats | None, tied: Ties | None, *, resized: bool
    ) -> None:
        """Book the losses of a block, each from the impulses of its own kind.

        Args:
            step: their size, in s.
            given: the impulses of a hand, (k, n, 3), in N s and N m s.
            tied: the joints, if there are any.
            resized: the step before the block had another size. Contacts then begin with the impulses of
                that step times the ratio of the sizes, and the engine tells them without that factor.
        """
        before, after = block.before, block.states[:, :, 3:]
        mean, half = (before + after) / 2, block.contacts.half
        pushed, lost, friction = self._of_contacts(block, mean)
        rods = np.zeros(len(mean))
        if tied is not None or half is not None or resized:
            # What nobody has been found for yet is the joints', or turns a body along an edge.
            left = (after - before) * self._inertias - self._weight_force.reshape(-1, 3) * step - pushed
            if given is not None:
                left -= given
            if tied is not None:
                pulled = tied.impulses(block.states, left, self._inertias)
                rods = -(pulled * mean).sum(axis=(1, 2))
                left -= pulled
            if half is not None:
                # How an edge's impulse is spread along it shows in how the body turns, and nowhere else.
                most = self._levers(block, half)
                turned = np.clip(left[:, :, 2], -most, most)
                left[:, :, 2] -= turned
                lost -= (turned * mean[:, :, 2]).sum(axis=1)
            if resized:
                lost[0] -= (left[0] * mean[0]).sum()
        self.contacts += float((lost - friction).sum())
        self.friction += float(friction.sum())
        self.rods += float(rods.sum())
        # Bodies are moved before they are accelerated, and out of each other without a velocity.
        jumps = block.states[-1, :, :2] - block.start - before[:, :, :2].sum(axis=0) * step
        self.integrator += float((before - after).sum(axis=0).ravel() @ self._weight_force) * step / 2
        self.integrator += float(jumps.ravel() @ self._weight_force.reshape(-1, 3)[:, :2].ravel())

    def _levers(self, block: Block, half: Floats) -> Floats:
        """The most that edges can turn each body beyond that, (k, n), in N m s."""
        c, (count, bodies) = block.contacts, block.states.shape[:2]
        most = np.hypot(*c.impulse) * half
        summed = [_by_place(c.row * bodies + body, most, count * bodies) for body in (c.a, c.b)]
        levers: Floats = (summed[0] + summed[1]).reshape(count, bodies) * (1 + 1e-9)
        return levers

    def work(self, block: Block, impulses: Floats) -> Floats:
        """What impulses gave that acted inside the steps, (k,), in J.

        Args:
            impulses: (k, n, 3), in N s and N m s.
        """
        work: Floats = ((block.before + block.states[:, :, 3:]) * impulses).sum(axis=(1, 2)) / 2
        return work

    def _of_contacts(self, block: Block, mean: Floats) -> tuple[Floats, Floats, Floats]:
        """What contacts did to each body in each step, (k, n, 3), in N s and N m s; what they took in each
        step, and how much of it along surfaces, (k,), in J.

        The velocity of a body's point p is ``(vx + w y - w py, vy - w x + w px)``, and the torque of an
        impulse ``p x J - x x J``: what does not depend on p is computed once per body.
        """
        c, (count, bodies) = block.contacts, mean.shape[:2]
        if not len(c.row):
            return np.zeros(mean.shape), np.zeros(count), np.zeros(count)
        a, b = c.row * bodies + c.a, c.row * bodies + c.b
        (jx, jy), (nx, ny), (px, py), (qx, qy) = c.impulse, c.normal, c.point, c.other
        pairs = ((jx, jx), (jy, jy), (px * jy - py * jx, qx * jy - qy * jx))
        sums: list[Floats] = [
            _by_place(a, on, count * bodies) - _by_place(b, back, count * bodies) for on, back in pairs
        ]
        pushed = np.stack(sums, axis=1).reshape(mean.shape)
        x, y, spin = block.states[:, :, 0], block.states[:, :, 1], mean[:, :, 2]
        pushed[:, :, 2] -= x * pushed[:, :, 1] - y * pushed[:, :, 0]
        vx, vy, spin = (mean[:, :, 0] + spin * y).ravel(), (mean[:, :, 1] - spin * x).ravel(), spin.ravel()
        slip = (vy.take(b) - vy.take(a)) * nx
        slip -= (vx.take(b) - vx.take(a)) * ny
        slip += spin.take(b) * (qx * nx + qy * ny)
        slip -= spin.take(a) * (px * nx + py * ny)
        slip *= jy * nx - jx * ny
        return pushed, -(pushed * mean).sum(axis=(1, 2)), _by_place(c.row, slip, count)


def _by_place(places: Ints, amounts: Floats, count: int) -> Floats:
    """Sums of the amounts that belong to the same place, (count,)."""
    return np.bincount(places, amounts, count).astype(np.float64, copy=False)


@dataclass(frozen=True, slots=True)
class Ties:
    """The joints of a space: which bodies they hold, and where.

    Attributes:
        bodies: indices of the two that each holds, (2, m).
        anchors: in the frames of the two, (2, m, 2), in m.
        of, axis: of each condition, which joint it is of, (c,), and the direction that it keeps, (c, 2); 0, 0
            for a rod, which keeps its own.
    """

    bodies: Ints
    anchors: Floats
    of: Ints
    axis: Floats

    def impulses(self, states: Floats, left: Floats, inertias: Floats) -> Floats:
        """The impulses with which joints account best for what is left of the momenta.

        With the conditions ``C v = 0`` that joints put on velocities, they can only push by ``C' s``. The
        sizes ``s`` are those for which ``C W (left - C' s) = 0``, with the inverse masses ``W``.

        Args:
            states: (k, n, 6).
            left: (k, n, 3), in N s and N m s.
            inertias: mass twice and moment, (n, 3); 0 for what does not move.

        Returns:
            (k, n, 3).
        """
        rows, inverse = self._conditions(states), np.zeros_like(inertias)
        np.divide(1.0, inertias, out=inverse, where=inertias > 0)
        weighted = rows * inverse.ravel()
        system = weighted @ rows.transpose(0, 2, 1)
        # Joints that keep the same direction twice share it.
        system += np.eye(len(self.of)) * (_SOFT * np.abs(system).max() + np.finfo(float).tiny)
        wanted = weighted @ left.reshape(len(left), -1, 1)
        pulled: Floats = (rows.transpose(0, 2, 1) @ np.linalg.solve(system, wanted)).reshape(left.shape)
        return pulled

    def _conditions(self, states: Floats) -> Floats:
        """(k, c, 3 n): a row for each direction that a joint keeps."""
        count, bodies = states.shape[:2]
        angle = states[:, self.bodies, 2]
        (x, y), cos, sin = self.anchors.transpose(2, 0, 1), np.cos(angle), np.sin(angle)
        arms = np.stack([cos * x - sin * y, sin * x + cos * y], axis=3)
        ends = states[:, self.bodies, :2] + arms
        along = ends[:, 1] - ends[:, 0]
        size = np.hypot(along[..., 0], along[..., 1])[..., None]
        along = np.divide(along, size, out=np.zeros_like(along), where=size > 0)
        kept = np.where((self.axis != 0.0).any(axis=1, keepdims=True), self.axis, along[:, self.of])
        rows, number = np.zeros((count, len(self.of), bodies, 3)), np.arange(len(self.of))
        for body, arm, sign in zip(self.bodies, arms.swapaxes(0, 1), (-1.0, 1.0), strict=True):
            turn = arm[:, self.of, 0] * kept[..., 1] - arm[:, self.of, 1] * kept[..., 0]
            rows[:, number, body[self.of]] += sign * np.concatenate([kept, turn[..., None]], axis=2)
        return rows.reshape(count, len(self.of), -1)


#: How much joints that keep the same direction give way to each other, as a part of what they hold.
_SOFT = 1e-12
#: How often a body that is placed is moved until it fits, and how well it has to, in m.
_TRIES, _NEAR = 80, 1e-4

_STATE = (
    batch.BodyFields.POSITION
    | batch.BodyFields.ANGLE
    | batch.BodyFields.VELOCITY
    | batch.BodyFields.ANGULAR_VELOCITY
)
_CONTACT = (
    batch.ArbiterFields.BODY_A_ID
    | batch.ArbiterFields.BODY_B_ID
    | batch.ArbiterFields.IS_FIRST_CONTACT
    | batch.ArbiterFields.TOTAL_IMPULSE
    | batch.ArbiterFields.NORMAL
    | batch.ArbiterFields.CONTACT_COUNT
    | batch.ArbiterFields.POINT_A_1
    | batch.ArbiterFields.POINT_B_1
    | batch.ArbiterFields.POINT_A_2
    | batch.ArbiterFields.POINT_B_2
)
#: Numbers of one contact in the engine's buffers.
_WHOLE, _NUMBERS = 4, 12


def versions() -> dict[str, str]:
    """The versions that a run needs in order to repeat bit by bit."""
    return {"pymunk": pymunk.version, "chipmunk": pymunk.chipmunk_version}


class Space:
    """A pymunk space whose bodies are known by their index.

    ``parts`` is kept in the engine's own order, which is the order of the rows of every state: movable bodies
    first, and where one is removed the last takes its place.

    Args:
        parts: the bodies, in the order they are added.
    """

    def __init__(
        self, parts: Sequence[Part], joints: Sequence[Joint], *, iterations: int, slop: float
    ) -> None:
        self.space = pymunk.Space()
        self.space.iterations = iterations
        self.space.collision_slop = slop
        # Arbiters of bodies that have parted are dropped at once, so the list holds only touching pairs.
        self.space.collision_persistence = 1
        self._bodies: dict[int, tuple[Part, pymunk.Body, pymunk.Shape]] = {}
        self._by_name: dict[str, int] = {}
        self.parts: tuple[Part, ...] = ()
        self._buffer = batch.Buffer()
        self.joints: list[pymunk.Constraint] = []
        for part in parts:
            self._insert(part)
        for joint in joints:
            self._join(joint)
        self._number()

    # -- building --------------------------------------------------------------------------------

    def add(self, part: Part, settings: Mapping[str, float]) -> None:
        """Add a body; restitution and friction in ``settings`` override its own."""
        restitution = settings.get("restitution", part.restitution)
        friction = settings.get("friction", part.friction)
        self._insert(replace(part, restitution=restitution, friction=friction))
        self._number()

    def remove(self, name: str) -> None:
        """Take a body out, and every joint that held it."""
        _, body, shape = self._bodies.pop(self._by_name.pop(name))
        held = self._joints_of(body)
        self.joints = [joint for joint in self.joints if joint not in held]
        self.space.remove(*held, shape, body)
        self._number()

    def _joints_of(self, body: pymunk.Body) -> list[pymunk.Constraint]:
        return [joint for joint in self.joints if body in (joint.a, joint.b)]

    def _insert(self, part: Part) -> None:
        body = pymunk.Body(body_type=pymunk.Body.STATIC)
        if not part.fixed:
            body = pymunk.Body(part.mass, part.moment)
            body.velocity = part.vx, part.vy
            body.angular_velocity = part.spin
        body.position = part.x, part.y
        body.angle = part.angle
        shape: pymunk.Shape
        match part.shape:
            case "circle":
                shape = pymunk.Circle(body, part.radius)
            case "segment":
                shape = pymunk.Segment(body, part.outline[0], part.outline[1], part.radius)
            case "polygon":
                shape = pymunk.Poly(body, list(part.outline))
            case _:
                assert_never(part.shape)
        shape.elasticity = part.restitution
        shape.friction = part.friction
        self.space.add(body, shape)
        self._bodies[body.id] = (part, body, shape)
        self._by_name[part.name] = body.id

    def _join(self, joint: Joint) -> None:
        kind = pymunk.PinJoint if joint.kind == "rod" else pymunk.PivotJoint
        made = kind(self.body(joint.a), self.body(joint.b), joint.anchor_a, joint.anchor_b)
        made.collide_bodies = joint.touch
        self.space.add(made)
        self.joints.append(made)

    def _number(self) -> None:
        """Learn the engine's order."""
        self._buffer.clear()
        batch.get_space_bodies(self.space, batch.BodyFields.BODY_ID, self._buffer)
        ids = np.frombuffer(self._buffer.int_buf(), dtype=np.uint64).copy()
        self.parts = tuple(self._bodies[int(body_id)][0] for body_id in ids)
        self.index = {part.name: i for i, part in enumerate(self.parts)}
        self._order = np.argsort(ids)
        self._sorted = ids[self._order]

    # -- one body --------------------------------------------------------------------------------

    def body(self, name: str) -> pymunk.Body:
        return self._bodies[self._by_name[name]][1]

    def part(self, name: str) -> Part:
        return self._bodies[self._by_name[name]][0]

    def number_of(self, name: str, key: str) -> float:
        """A body's mass, restitution, friction, vx, vy or spin."""
        _, body, shape = self._bodies[self._by_name[name]]
        found = {
            "mass": body.mass,
            "restitution": shape.elasticity,
            "friction": shape.friction,
            "vx": body.velocity.x,
            "vy": body.velocity.y,
            "spin": body.angular_velocity,
        }
        return float(found[key])

    def change(self, name: str, key: str, value: float) -> None:
        part, body, shape = self._bodies[self._by_name[name]]
        match key:
            case "mass":
                part = replace(part, mass=value, moment=part.moment * value / part.mass)
                body.mass, body.moment = part.mass, part.moment
            case "restitution":
                part, shape.elasticity = replace(part, restitution=value), value
            case "friction":
                part, shape.friction = replace(part, friction=value), value
            case "vx":
                body.velocity = value, body.velocity.y
            case "vy":
                body.velocity = body.velocity.x, value
            case "spin":
                body.angular_velocity = value
        self._bodies[body.id] = part, body, shape
        self._number()

    def place(self, name: str, x: float, y: float) -> bool:
        """Put a body's centre at a place, or as near as joints and other bodies let it.

        Returns:
            whether it fits; else it is where it was.
        """
        _, body, shape = self._bodies[self._by_name[name]]
        was = body.position
        body.position = x, y
        for _ in range(_TRIES):
            # One after the other, and again until both agree: what a rod asks for may be in another body.
            off = self._onto_joints(body) + self._out_of_others(body, shape)
            if off < _NEAR * 1e-3:
                break
        if off > _NEAR:
            body.position = was
        self.space.reindex_shapes_for_body(body)
        return bool(off <= _NEAR)

    def copy(self, name: str, made: str) -> bool:
        """Another body like this one, where there is room beside it. Returns whether there was."""
        part, body, old = self._bodies[self._by_name[name]]
        size = max([part.radius, *(math.hypot(*corner) for corner in part.outline)])
        vx, vy = body.velocity
        spin = body.angular_velocity
        self._insert(replace(part, name=made, angle=body.angle, vx=vx, vy=vy, spin=spin, appears=0.0))
        _, _, shape = self._bodies[self._by_name[made]]
        shape.elasticity, shape.friction = old.elasticity, old.friction
        x, y = body.position
        for far in (2.1, 3.2, 4.3):
            for turn in range(8):
                way = math.tau * turn / 8
                if self.place(made, x + far * size * math.cos(way), y + far * size * math.sin(way)):
                    self._number()
                    return True
        self.remove(made)
        return False

    def _onto_joints(self, body: pymunk.Body) -> float:
        """Move a body to where its joints hold it; how far that was, in m."""
        moved = 0.0
        for joint in self._joints_of(body):
            mine, other, its = joint.anchor_a, joint.b, joint.anchor_b
            if body is joint.b:
                mine, other, its = joint.anchor_b, joint.a, joint.anchor_a
            arm = body.local_to_world(mine) - other.local_to_world(its)
            length = joint.distance if isinstance(joint, pymunk.PinJoint) else 0.0
            size = arm.length
            wanted = arm * (length / size) if size > 0 else pymunk.Vec2d(0.0, -length)
            body.position += wanted - arm
            moved += (wanted - arm).length
        return moved

    def _out_of_others(self, body: pymunk.Body, shape: pymunk.Shape) -> float:
        """Move a body out of all others; how far that was, in m."""
        apart = [joint for joint in self._joints_of(body) if not joint.collide_bodies]
        through = {body, *(joint.a for joint in apart), *(joint.b for joint in apart)}
        moved = 0.0
        for hit in self.space.shape_query(shape):
            if hit.shape is None or hit.shape.body in through:
                continue
            nearest = min((point.distance for point in hit.contact_point_set.points), default=0.0)
            depth = nearest + self.space.collision_slop
            if depth < 0.0:
                body.position += hit.contact_point_set.normal * depth
                moved -= depth
        return moved

    def set_material(self, settings: Mapping[str, float]) -> None:
        """Give every movable body the restitution and friction among ``settings``; fixed ones keep theirs."""
        for part, _, shape in self._bodies.values():
            if not part.fixed:
                shape.elasticity = settings.get("restitution", shape.elasticity)
                shape.friction = settings.get("friction", shape.friction)

    def nearest(self, x: float, y: float, reach: float) -> str | None:
        """The movable body closest to a place, if its surface is within ``reach`` of it, in m."""
        near: list[tuple[float, str]] = []
        for hit in self.space.point_query((x, y), reach, pymunk.ShapeFilter()):
            if hit.shape is not None and hit.shape.body is not None:
                part = self._bodies[hit.shape.body.id][0]
                near += [] if part.fixed else [(hit.distance, part.name)]
        return min(near)[1] if near else None

    def ends_of_joints(self) -> Floats:
        """Where each joint's two anchors are now, (m, 4), in m."""
        ends = [
            (*joint.a.local_to_world(joint.anchor_a), *joint.b.local_to_world(joint.anchor_b))
            for joint in self.joints
        ]
        return np.array(ends, dtype=float).reshape(-1, 4)

    def ties(self) -> Ties | None:
        """What the joints hold, by the rows of every state; None if there are none."""
        if not self.joints:
            return None
        bodies = [[self.index[self._bodies[end.id][0].name] for end in (j.a, j.b)] for j in self.joints]
        anchors = np.array([[tuple(j.anchor_a), tuple(j.anchor_b)] for j in self.joints], dtype=float)
        kept = [
            (number, axis)
            for number, joint in enumerate(self.joints)
            for axis in ([(0, 0)] if isinstance(joint, pymunk.PinJoint) else [(1, 0), (0, 1)])
        ]
        return Ties(
            bodies=np.array(bodies).T,
            anchors=anchors.transpose(1, 0, 2),
            of=np.array([number for number, _ in kept]),
            axis=np.array([axis for _, axis in kept], dtype=float),
        )

    # -- everything at once ----------------------------------------------------------------------

    def state(self) -> Floats:
        """All bodies now, (n, 6)."""
        self._buffer.clear()
        batch.get_space_bodies(self.space, _STATE, self._buffer)
        return np.frombuffer(self._buffer.float_buf(), dtype=np.float64).reshape(-1, 6).copy()

    def indices(self, ids: NDArray[np.uint64]) -> Ints:
        """Rows of bodies, from the engine's ids, which are addresses."""
        found: Ints = self._order.take(self._sorted.searchsorted(ids))
        return found


class Recorder:
    """Copies states and contacts out after each step; appending costs no Python per body.

    Args:
        space: whose.
    """

    def __init__(self, space: Space) -> None:
        self._space = space
        self._states = batch.Buffer()
        self._contacts = batch.Buffer()
        self._ends: list[int] = []

    def __len__(self) -> int:
        return len(self._ends)

    def take(self) -> None:
        """Append the step that was just made."""
        batch.get_space_bodies(self._space.space, _STATE, self._states)
        batch.get_space_arbiters(self._space.space, _CONTACT, self._contacts)
        self._ends.append(len(self._contacts.int_buf()))

    def block(self) -> tuple[Floats, Contacts]:
        """Everything since the last call: states (k, n, 6) and the contacts; then empty.

        They are views of the engine's memory, which the next step overwrites.
        """
        count = len(self._ends)
        states = np.frombuffer(self._states.float_buf(), dtype=np.float64).reshape(count, -1, 6)
        ends = np.array(self._ends) // (8 * _WHOLE)
        whole = np.frombuffer(self._contacts.int_buf(), dtype=np.uint64).reshape(-1, _WHOLE)
        # Columns side by side: reading them out of wide rows again and again costs more.
        numbers = np.frombuffer(self._contacts.float_buf(), dtype=np.float64).reshape(-1, _NUMBERS).T.copy()
        edges, half = whole[:, 3] == 2, None
        if edges.any():
            to_middle = (numbers[8:12] - numbers[4:8]) * (edges / 2)
            numbers[4:8] += to_middle
            half = np.maximum(np.hypot(*to_middle[:2]), np.hypot(*to_middle[2:]))
        contacts = Contacts(
            row=np.repeat(np.arange(count), np.diff(ends, prepend=0)),
            a=self._space.indices(whole[:, 0]),
            b=self._space.indices(whole[:, 1]),
            first=whole[:, 2],
            impulse=numbers[0:2],
            normal=numbers[2:4],
            point=numbers[4:6],
            other=numbers[6:8],
            half=half,
        )
        self._states.clear()
        self._contacts.clear()
        self._ends.clear()
        return states, contacts
