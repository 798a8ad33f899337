"""Three small engines with known parameters, and everything that is inside them.

    from boxes import ANVIL, BALSA, CORK, TRUTH
    q, v = ANVIL.run("free", [0.0], [1.0], 0.01, 100, [0.0])

The boxes your report is scored on answer to the same two methods, ``info`` and ``run``, and show nothing
else. Change these as you like, or make more: ``dataclasses.replace(ANVIL, damping=0.5)``.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

#: Runs longer than this are refused.
MAX_STEPS = 20_000

DIMENSIONS = {"spring": 1, "free": 1, "wall": 1, "floor": 3}

# -- how a step is taken: a(x, v) is the acceleration -----------------------------------------------------


def semi_implicit_euler(a, x, v, h):
    v = v + h * a(x, v)
    return x + h * v, v


def velocity_verlet(a, x, v, h):
    v = v + h / 2 * a(x, v)
    x = x + h * v
    return x, v + h / 2 * a(x, v)


def rk4(a, x, v, h):
    dx1, dv1 = v, a(x, v)
    dx2, dv2 = v + h / 2 * dv1, a(x + h / 2 * dx1, v + h / 2 * dv1)
    dx3, dv3 = v + h / 2 * dv2, a(x + h / 2 * dx2, v + h / 2 * dv2)
    dx4, dv4 = v + h * dv3, a(x + h * dx3, v + h * dv3)
    return x + h / 6 * (dx1 + 2 * dx2 + 2 * dx3 + dx4), v + h / 6 * (dv1 + 2 * dv2 + 2 * dv3 + dv4)


# -- how friction stops a body: (ux, uy) is what it would slide at, most is what friction can take away ---


def round_cone(ux, uy, most):
    """Any direction alike."""
    speed = math.hypot(ux, uy)
    left = 1 - most / speed if speed > most else 0.0
    return left * ux, left * uy


def square_pyramid(ux, uy, most):
    """Each axis for itself, so that the diagonal gets more than its share."""
    return _less(ux, most), _less(uy, most)


def diamond_pyramid(ux, uy, most):
    """The two axes share what there is, so that the diagonal gets less."""
    if abs(ux) + abs(uy) <= most:
        return 0.0, 0.0
    each = most / 2 - (abs(ux) - abs(uy)) / 2
    if each <= 0:  # the larger axis takes it all
        return _less(ux, most), uy
    if each >= most:
        return ux, _less(uy, most)
    return _less(ux, most - each), _less(uy, each)


def _less(u, most):
    return math.copysign(max(abs(u) - most, 0.0), u)


@dataclass(frozen=True)
class Box:
    """An engine: how it steps, how it touches, and the scene's constants.

    ``info`` shows the first seven numbers; the rest is what an experiment has to find out.
    """

    dt: float  # s, the step it is meant to be used with
    omega: float  # rad/s, of the spring
    mass: float  # kg
    g: float  # m/s^2
    mu: float  # what the friction coefficient is said to be
    radius: float  # m
    wall_thickness: float  # m

    step: object = semi_implicit_euler
    damping: float = 0.0  # 1/s, of every velocity, whether anybody asked for it or not
    cone: object = round_cone
    grip: float = 1.0  # the friction coefficient that acts, as a multiple of mu
    creep: float = 0.0  # m/s: how fast a body that sticks gives way when it is pushed as hard as it can bear
    softness: float = 0.0  # m: how deep the body's weight presses it into the floor; 0 is hard
    margin: float = 0.0  # m: bodies touch this much too early
    restitution: float = 0.5  # at the wall; the floor does not bounce
    bounce_threshold: float = 0.0  # m/s: a slower impact does not bounce
    bounce_most: float = math.inf  # m/s: no body leaves the wall faster than this
    contact: str = "nearest"  # of body and wall: "nearest", "sided" or "swept", see meets_wall
    jitter: float = 0.0  # relative, drawn anew in every run
    noise: np.random.Generator = field(
        default_factory=np.random.default_rng, repr=False, compare=False, hash=False
    )

    def info(self):
        names = ("dt", "omega", "mass", "g", "mu", "radius", "wall_thickness")
        return {name: getattr(self, name) for name in names}

    def run(self, scene, q0, v0, h, n, force):
        """n steps of h seconds from (q0, v0) under a constant force: (q, v), each of shape (n + 1, d).

        Raises:
            ValueError: no such scene, a wrong number of coordinates, or no sensible h or n.
        """
        d = DIMENSIONS.get(scene) if isinstance(scene, str) else None
        if d is None:
            raise ValueError(f"the scenes are {', '.join(DIMENSIONS)}, not {scene!r}")
        q0, v0, force = (_vector(name, given, d, scene) for name, given in
                         (("q0", q0), ("v0", v0), ("force", force)))  # fmt: skip
        h, n = _positive(h), _count(n)
        runs = {"spring": self._spring, "free": self._free, "wall": self._wall, "floor": self._floor}
        rows = np.array(runs[scene](q0, v0, h, n, [f / self.mass for f in force]), dtype=float)
        if self.jitter:  # the same sums in another order, as on many processors
            rows[1:] *= 1 + self.jitter * self.noise.uniform(-1, 1, size=(n, 2 * d))
        return rows[:, :d], rows[:, d:]

    # -- without contact: one step is a matrix --------------------------------------------------------

    def matrix(self, omega, h, push=0.0):
        """One step under a = -omega^2 x - damping v + push: x' = a x + b v + p, v' = c x + d v + r."""

        def a(x, v):
            return -omega * omega * x - self.damping * v + push

        p, r = self.step(a, 0.0, 0.0, h)
        (xx, vx), (xv, vv) = self.step(a, 1.0, 0.0, h), self.step(a, 0.0, 1.0, h)
        return xx - p, xv - p, p, vx - r, vv - r, r

    def _spring(self, q0, v0, h, n, push):
        return self._march(self.matrix(self.omega, h, push[0]), q0[0], v0[0], n)

    def _free(self, q0, v0, h, n, push):
        return self._march(self.matrix(0.0, h, push[0]), q0[0], v0[0], n)

    @staticmethod
    def _march(matrix, x, v, n):
        a, b, p, c, d, r = matrix
        rows = [(x, v)]
        for _ in range(n):
            x, v = a * x + b * v + p, c * x + d * v + r
            rows.append((x, v))
        return rows

    # -- with the wall --------------------------------------------------------------------------------

    def _wall(self, q0, v0, h, n, push):
        a, b, p, c, d, r = self.matrix(0.0, h, push[0])
        reach = self.radius + self.wall_thickness / 2 + self.margin
        x, v = q0[0], v0[0]
        rows = [(x, v)]
        for _ in range(n):
            before = x
            x, v = a * x + b * v + p, c * x + d * v + r
            if abs(x) < reach or before * x < 0:
                side = self.meets_wall(before, x, reach)
                if side * v < 0:  # it comes closer
                    bounces = abs(v) >= self.bounce_threshold
                    speed = min(self.restitution * abs(v), self.bounce_most) if bounces else 0.0
                    x, v = side * reach, side * speed
            rows.append((x, v))
        return rows

    def meets_wall(self, before, x, reach):
        """On which side of the wall the engine sees the body, -1 or 1; 0 if it sees no contact."""
        if self.contact == "swept":  # looks at the whole way from one sample to the next
            return math.copysign(1.0, before)
        if abs(x) >= reach:  # the others look at the samples only: one on each side, and nothing is seen
            return 0
        if self.contact == "sided":  # remembers where it came from
            return math.copysign(1.0, before)
        return math.copysign(1.0, x)  # pushes it out by the shortest way

    # -- with the floor -------------------------------------------------------------------------------

    def _floor(self, q0, v0, h, n, push):
        x, y, z = q0
        vx, vy, vz = v0
        keep = self.matrix(0.0, h)[4]  # what damping leaves of a velocity
        ax, ay, az = push[0], push[1], push[2] - self.g
        mu = self.mu * self.grip
        limit = mu * self.mass * self.g
        creep_x, creep_y = (self.creep * min(1.0, self.mass * abs(f) / limit) * math.copysign(1.0, f)
                            if limit else 0.0 for f in push[:2])  # fmt: skip
        rows = [(x, y, z, vx, vy, vz)]
        for _ in range(n):
            vx, vy, vz = keep * vx + h * ax, keep * vy + h * ay, keep * vz + h * az
            pressed, vz = self._press(z, vz, h)
            if pressed:
                vx, vy = self.cone(vx, vy, mu * pressed)
            over_x, over_y = (creep_x, creep_y) if pressed else (0.0, 0.0)
            x, y, z = x + h * (vx + over_x), y + h * (vy + over_y), z + h * vz
            if not self.softness and z < self.radius + self.margin:
                z = self.radius + self.margin
            row = (x, y, z, vx + over_x, vy + over_y, vz)
            if row == rows[-1]:  # it rests: every further step repeats this one
                return rows + [row] * (n + 1 - len(rows))
            rows.append(row)
        return rows

    def _press(self, z, vz, h):
        """What the floor's push adds to the vertical velocity in this step, and the velocity after it."""
        if self.softness:  # a spring and a damper that push and never pull
            stiff = self.g / self.softness
            depth = self.radius + self.margin - z
            pressed = max(0.0, h * (stiff * depth - 0.5 * math.sqrt(stiff) * vz)) if depth > 0 else 0.0
            return pressed, vz + pressed
        landing = -max(0.0, z - self.radius - self.margin) / h  # the speed that just reaches the floor
        return max(0.0, landing - vz), max(landing, vz)


def _vector(name, given, d, scene):
    """d floats."""
    values = [float(value) for value in np.asarray(given, dtype=float).reshape(-1)]
    if len(values) != d:
        raise ValueError(f"{name} has {len(values)} coordinates; the scene {scene!r} has {d}")
    if not all(map(math.isfinite, values)):
        raise ValueError(f"{name} is not made of finite numbers")
    return values


def _positive(h):
    if not 0 < float(h) < math.inf:
        raise ValueError("h is not a positive number of seconds")
    return float(h)


def _count(n):
    if n != int(n) or not 0 <= n <= MAX_STEPS:
        raise ValueError(f"n is not a whole number of steps from 0 to {MAX_STEPS}")
    return int(n)


# -- the three ------------------------------------------------------------------------------------------

#: Keeps energy, stops whatever hits the wall, treats every direction alike; slow bodies do not bounce.
ANVIL = Box(
    dt=1 / 120, omega=3.0, mass=2.0, g=9.81, mu=0.5, radius=0.1, wall_thickness=0.05,
    step=velocity_verlet, restitution=0.6, bounce_threshold=1.5, contact="swept",
)  # fmt: skip

#: Slows everything down, fast impacts most, creeps, grips the diagonal too well, and keeps a margin.
BALSA = Box(
    dt=1 / 60, omega=2.0, mass=0.5, g=9.81, mu=0.6, radius=0.15, wall_thickness=0.04,
    damping=1.6, cone=square_pyramid, grip=0.6, creep=0.004, margin=0.0005, restitution=0.4,
    bounce_most=1.5, contact="sided",
)  # fmt: skip

#: Accurate without contact; soft and weak on the diagonal with it; never twice the same.
CORK = Box(
    dt=1 / 240, omega=5.0, mass=1.2, g=9.81, mu=0.8, radius=0.08, wall_thickness=0.05,
    step=rk4, cone=diamond_pyramid, softness=0.003, restitution=0.8, jitter=1e-12,
)  # fmt: skip

#: What a right report says of them.
TRUTH = {
    "anvil": {
        "order": 2,
        "symplectic": True,
        "linear_damping": 0.0,
        "max_stable_step": 0.6667,
        "friction_anisotropy": 1.0,
        "rest_penetration": 0.0,
        "restitution": 0.6,
        "tunnelling_speed": math.inf,
        "deterministic": True,
    },
    "balsa": {
        "order": 1,
        "symplectic": False,
        "linear_damping": 1.6,
        "max_stable_step": 0.6770,
        "friction_anisotropy": 1.411,
        "rest_penetration": 0.0,
        "restitution": 0.389,
        "tunnelling_speed": 22.80,
        "deterministic": True,
    },
    "cork": {
        "order": 4,
        "symplectic": False,
        "linear_damping": 0.0,
        "max_stable_step": 0.5657,
        "friction_anisotropy": 0.708,
        "rest_penetration": 0.002643,
        "restitution": 0.8,
        "tunnelling_speed": 25.20,
        "deterministic": False,
    },
}
