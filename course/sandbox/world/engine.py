"""The only module that knows pymunk: bodies made from parts, and states and contacts copied out of it."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, TypeAlias, assert_never

import numpy as np
import pymunk
from numpy.typing import NDArray
from pymunk import batch

from course.errors import InternalError
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

#: Columns of a state: a row per body.
COLUMNS = ("x", "y", "angle", "vx", "vy", "spin")


@dataclass(frozen=True, slots=True)
class Contacts:
    """All contacts of some steps, a row each.

    Attributes:
        row: which step of the block, 0 first.
        a, b: indices of the bodies.
        first: 1 where the two did not touch in the step before.
        impulse: on ``a``, in N s, (n, 2).
        normal: from ``a`` to ``b``, (n, 2).
        point: in m, (n, 2).
    """

    row: Ints
    a: Ints
    b: Ints
    first: NDArray[np.uint64]
    impulse: Floats
    normal: Floats
    point: Floats


@dataclass(frozen=True, slots=True)
class Block:
    """A few consecutive steps.

    Attributes:
        first_step: number of the first of them.
        times: at their ends, in s, (k,).
        before: velocities and spin at the start of each step, (k, n, 3).
        states: state at the end of each, (k, n, 6), columns as in ``COLUMNS``. Like the contacts these
            are the engine's own memory: good until the next step, so copy what is to be kept.
        contacts: during them.
    """

    first_step: int
    times: Floats
    before: Floats
    states: Floats
    contacts: Contacts


class Ledger:
    """Sums of the losses, by place.

    Args:
        parts: the bodies, in the order of the rows of every state.
        gravity: in m/s².
        joints: whether joints do work as well; their errors then go to the residual.
    """

    def __init__(self, parts: Sequence[Part], gravity: tuple[float, float], *, joints: bool) -> None:
        self.contacts = 0.0
        self.friction = 0.0
        self.rods = 0.0
        self.integrator = 0.0
        self.given = 0.0
        self.start = 0.0
        self.joints = joints
        self.adopt(parts, gravity)

    def adopt(self, parts: Sequence[Part], gravity: tuple[float, float]) -> None:
        """Switch to another set of bodies, or another gravity; the sums stay."""
        finite = [p.moment if np.isfinite(p.moment) else 0.0 for p in parts]
        self.mass = np.array([p.mass for p in parts])
        self.inertia = np.array(finite)
        self.gravity = gravity
        self._weights = np.column_stack([self.mass, self.mass, self.inertia]).ravel() / 2
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

    def settle(self, block: Block, step: float, given: Floats | float = 0.0) -> tuple[Floats, Floats]:
        """Book the losses of a block.

        Args:
            block: the steps.
            step: their size, in s.
            given: what a hand gave in each step, (k,), in J.

        Returns:
            what each step lost at contacts, (k,), and by friction, (k,), in J.
        """
        count = len(block.times)
        before, after = block.before, block.states[:, :, 3:]
        mean = (before + after) / 2
        from_gravity = mean.reshape(count, -1) @ self._weight_force * step
        contacts, friction = self._of_contacts(block, mean, count)
        if not self.joints and len(block.contacts.row):
            gained = self.energies(after) - self.energies(before)
            contacts = from_gravity + given - gained - friction
        self.contacts += float(contacts.sum())
        self.friction += float(friction.sum())
        self.integrator += float((before[0] - after[-1]).ravel() @ self._weight_force) * step / 2
        return contacts, friction

    def energies(self, velocities: Floats) -> Floats:
        """Kinetic energies of several states, (k,), in J; velocities (k, n, 3)."""
        energies: Floats = (velocities * velocities).reshape(len(velocities), -1) @ self._weights
        return energies

    def table(self, states: Floats) -> Floats:
        """Kinetic and potential energy, and momentum along x, y and about the origin, of states (k, n, 6)."""
        x, y, vx, vy, spin = (states[:, :, i] for i in (0, 1, 3, 4, 5))
        heights = states[:, :, :2].reshape(len(states), -1) @ self._heights
        angular = (x * vy - y * vx) @ self.mass + spin @ self.inertia
        return np.column_stack(
            [self.energies(states[:, :, 3:]), heights, vx @ self.mass, vy @ self.mass, angular]
        )

    def work(self, block: Block, impulses: Floats) -> Floats:
        """What impulses gave that acted inside the steps, (k,), in J.

        Args:
            block: the steps.
            impulses: (k, n, 3), in N s and N m s.
        """
        work: Floats = ((block.before + block.states[:, :, 3:]) * impulses).sum(axis=(1, 2)) / 2
        return work

    def _of_contacts(self, block: Block, mean: Floats, count: int) -> tuple[Floats, Floats]:
        """Energy that impulses took along normals and along surfaces, by step.

        The velocity of a body's point p is ``(vx + w y - w py, vy - w x + w px)``: what does not depend on p
        is computed once per body, and only three numbers per body are looked up for each contact.
        """
        c = block.contacts
        zero = np.zeros(count)
        if not len(c.row):
            return zero, zero
        spin = mean[:, :, 2]
        field = np.stack(
            [mean[:, :, 0] + spin * block.states[:, :, 1], mean[:, :, 1] - spin * block.states[:, :, 0], spin]
        ).reshape(3, -1)
        start = c.row * mean.shape[1]
        a, b = start + c.a, start + c.b
        vx, vy, turn = (column.take(b) - column.take(a) for column in field)
        # Columns once, side by side: reading them out of wide rows again and again costs more.
        px, py = c.point.T.copy()
        nx, ny = c.normal.T.copy()
        jx, jy = c.impulse.T.copy()
        vx -= turn * py
        vy += turn * px
        along = (jy * nx - jx * ny) * (vy * nx - vx * ny)
        friction: Floats = np.bincount(c.row, weights=along, minlength=count).astype(np.float64)
        if not self.joints:
            return zero, friction
        across = (jx * nx + jy * ny) * (vx * nx + vy * ny)
        return np.bincount(c.row, weights=across, minlength=count).astype(np.float64), friction


# ---


#: Ids of bodies are addresses.
Ids: TypeAlias = NDArray[np.uint64]

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
    | batch.ArbiterFields.POINT_A_1
)
#: In a world with joints the middle of a contact along an edge matters, so both its points are read.
_BOTH_POINTS = _CONTACT | batch.ArbiterFields.CONTACT_COUNT | batch.ArbiterFields.POINT_A_2


def versions() -> dict[str, str]:
    """The versions that a run needs in order to repeat bit by bit."""
    return {"pymunk": pymunk.version, "chipmunk": pymunk.chipmunk_version}


class Space:
    """A pymunk space whose bodies are known by their index.

    ``parts`` is kept in the engine's own order, which is the order of the rows of every state: movable bodies
    first, and where one is removed the last takes its place.

    Args:
        parts: the bodies, in the order they are added.
        joints: what holds them together.
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
        held = [joint for joint in self.joints if body in (joint.a, joint.b)]
        self.joints = [joint for joint in self.joints if joint not in held]
        self.space.remove(*held, shape, body)
        self._number()

    def _insert(self, part: Part) -> None:
        body = (
            pymunk.Body(body_type=pymunk.Body.STATIC) if part.fixed else pymunk.Body(part.mass, part.moment)
        )
        body.position = part.x, part.y
        body.angle = part.angle
        if not part.fixed:
            body.velocity = part.vx, part.vy
            body.angular_velocity = part.spin
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
        """Learn the engine's order, and how to get from its ids to indices without a search."""
        self._buffer.clear()
        batch.get_space_bodies(self.space, batch.BodyFields.BODY_ID, self._buffer)
        ids = np.frombuffer(self._buffer.int_buf(), dtype=np.uint64).copy()
        self.parts = tuple(self._bodies[int(body_id)][0] for body_id in ids)
        self.index = {part.name: i for i, part in enumerate(self.parts)}
        self._factor, self._shift, self._table = _perfect_hash(ids)

    # -- one body --------------------------------------------------------------------------------

    def body(self, name: str) -> pymunk.Body:
        return self._bodies[self._by_name[name]][1]

    def names(self) -> list[str]:
        """All bodies, in the order they were added."""
        return list(self._by_name)

    def part(self, name: str) -> Part:
        return self._bodies[self._by_name[name]][0]

    def set_material(self, *, restitution: float | None = None, friction: float | None = None) -> None:
        """Give every movable body another restitution or friction; fixed ones keep theirs."""
        for part, _, shape in self._bodies.values():
            if not part.fixed:
                if restitution is not None:
                    shape.elasticity = restitution
                if friction is not None:
                    shape.friction = friction

    def nearest(self, x: float, y: float, reach: float) -> str | None:
        """The movable body closest to a place, if its surface is within ``reach`` of it, in m."""
        best: tuple[float, str] | None = None
        for hit in self.space.point_query((x, y), reach, pymunk.ShapeFilter()):
            if hit.shape is None or hit.shape.body is None:
                continue
            part = self._bodies[hit.shape.body.id][0]
            if not part.fixed and (best is None or (hit.distance, part.name) < best):
                best = (hit.distance, part.name)
        return best[1] if best else None

    def ends_of_joints(self) -> list[tuple[float, float, float, float]]:
        """Where each joint's two anchors are now, in m."""
        ends = []
        for joint in self.joints:
            a: Any = joint.a.local_to_world(joint.anchor_a)
            b: Any = joint.b.local_to_world(joint.anchor_b)
            ends.append((float(a.x), float(a.y), float(b.x), float(b.y)))
        return ends

    def stopped_by_joints(self) -> float:
        """The energy that joints take from bodies that move against them, in J.

        An ideal joint takes what of the velocities it does not allow, at once, with the least impulse that
        does. With conditions ``J v = 0`` and inverse masses ``W`` that is ``(J v)' (J W J')^-1 (J v) / 2``.
        """
        if not self.joints:
            return 0.0
        rows: list[Floats] = []
        for joint, (ax, ay, bx, by) in zip(self.joints, self.ends_of_joints(), strict=True):
            along = np.array([bx - ax, by - ay])
            rod = isinstance(joint, pymunk.PinJoint) and bool(along.any())
            for nx, ny in [along / np.hypot(*along)] if rod else np.eye(2):
                row = np.zeros((len(self.parts), 3))
                for body, x, y, sign in ((joint.a, ax, ay, -1.0), (joint.b, bx, by, 1.0)):
                    part = self._bodies[body.id][0]
                    turn = (x - body.position.x) * ny - (y - body.position.y) * nx
                    row[self.index[part.name]] += sign * np.array([nx, ny, turn])
                rows.append(row.ravel())
        conditions = np.array(rows)
        masses = [(0.0,) * 3 if p.fixed else (1 / p.mass, 1 / p.mass, 1 / p.moment) for p in self.parts]
        wrong = conditions @ self.state()[:, 3:].ravel()
        least = np.linalg.lstsq(conditions * np.ravel(masses) @ conditions.T, wrong, rcond=None)[0]
        return float(wrong @ least) / 2

    # -- everything at once ----------------------------------------------------------------------

    def state(self) -> Floats:
        """All bodies now, (n, 6)."""
        self._buffer.clear()
        batch.get_space_bodies(self.space, _STATE, self._buffer)
        return np.frombuffer(self._buffer.float_buf(), dtype=np.float64).reshape(-1, 6).copy()

    def indices(self, ids: Ids) -> Ints:
        """Rows of bodies, from the engine's ids."""
        places = ids * self._factor
        places >>= self._shift
        found: Ints = self._table.take(places.view(np.int64))
        return found

    def on_contact(self, tell: Callable[[str, str, Any], None]) -> None:
        """Call ``tell(name of a, name of b, arbiter)`` from inside the step, when two begin to touch."""

        def begin(arbiter: pymunk.Arbiter, space: pymunk.Space, data: Any) -> None:  # noqa: ARG001
            a, b = arbiter.bodies
            tell(self._bodies[a.id][0].name, self._bodies[b.id][0].name, arbiter)

        self.space.on_collision(None, None, begin=begin)


class Recorder:
    """Copies states and contacts out after each step; appending costs no Python per body.

    Args:
        space: whose.
        both_points: read both points of contacts along an edge.
    """

    def __init__(self, space: Space, *, both_points: bool) -> None:
        self._space = space
        self._states = batch.Buffer()
        self._contacts = batch.Buffer()
        self._fields = _BOTH_POINTS if both_points else _CONTACT
        self._whole, self._numbers = (4, 8) if both_points else (3, 6)
        self._ends: list[int] = []

    def __len__(self) -> int:
        return len(self._ends)

    def take(self) -> None:
        """Append the step that was just made."""
        batch.get_space_bodies(self._space.space, _STATE, self._states)
        batch.get_space_arbiters(self._space.space, self._fields, self._contacts)
        self._ends.append(len(self._contacts.int_buf()))

    def block(self) -> tuple[Floats, Contacts]:
        """Everything since the last call: states (k, n, 6) and the contacts; then empty.

        They are views of the engine's memory, which the next step overwrites.
        """
        count = len(self._ends)
        states = np.frombuffer(self._states.float_buf(), dtype=np.float64).reshape(count, -1, 6)
        ends = np.array(self._ends) // (8 * self._whole)
        whole = np.frombuffer(self._contacts.int_buf(), dtype=np.uint64).reshape(-1, self._whole)
        numbers = np.frombuffer(self._contacts.float_buf(), dtype=np.float64).reshape(-1, self._numbers)
        point = numbers[:, 4:6]
        if self._whole == 4:
            along_edge = (whole[:, 3] == 2)[:, None]
            point = np.where(along_edge, (point + numbers[:, 6:8]) / 2, point)
        bodies = [self._space.indices(whole[:, i]) for i in (0, 1)]
        contacts = Contacts(
            row=np.repeat(np.arange(count), np.diff(ends, prepend=0)),
            a=bodies[0],
            b=bodies[1],
            first=whole[:, 2],
            impulse=numbers[:, 0:2],
            normal=numbers[:, 2:4],
            point=point,
        )
        self._states.clear()
        self._contacts.clear()
        self._ends.clear()
        return states, contacts


def _perfect_hash(ids: Ids) -> tuple[np.uint64, np.uint64, Ints]:
    """A factor and a shift that send every id to a place of its own, and the table of what stands there.

    Ids are addresses, so they may be any distance apart. Factors are tried until no two ids collide, in a
    table that starts small, since it has to stay in the cache, and is doubled after too many failures.
    """
    bits = max(6, math.ceil(math.log2(16 * max(len(ids), 1))))
    while bits < 40:
        shift = np.uint64(64 - bits)
        for attempt in range(60):
            factor = np.uint64((0x9E3779B97F4A7C15 * (2 * attempt + 1)) % 2**64)
            places = (ids * factor) >> shift
            if len(np.unique(places)) == len(ids):
                table = np.zeros(2**bits, dtype=np.int64)
                table[places] = np.arange(len(ids))
                return factor, shift, table
        bits += 1
    raise InternalError("No table for the bodies of this scene could be found.")
