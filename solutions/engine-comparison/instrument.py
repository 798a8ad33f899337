"""What a right report says of a box, found with knowledge of what is inside it.

A submission has only ``info`` and ``run``. These functions look at the box's own one-step matrix and wall
geometry instead, so they share no method of measuring with any solution.
"""

from __future__ import annotations

import math

import numpy as np

SLIP = 0.01  # m/s, from the contract
FASTEST = 200.0  # m/s, from the contract

#: Order of each way to step, by the function's name.
ORDERS = {
    "explicit_euler": 1,
    "semi_implicit_euler": 1,
    "position_first_euler": 1,
    "implicit_euler": 1,
    "midpoint": 2,
    "velocity_verlet": 2,
    "uneven_verlet": 2,
    "uneven_euler": 1,
    "kutta": 3,
    "rk4": 4,
}


def truth(box) -> dict:
    """The report that the contract defines, for one box."""
    return {
        "order": ORDERS[box.step.__name__],
        "symplectic": abs(_determinant(box, 0.5 / box.omega) - 1) < 1e-6,
        "linear_damping": box.damping,
        "max_stable_step": max_stable_step(box),
        "friction_anisotropy": least_force(box, math.pi / 4) / least_force(box, 0.0),
        "rest_penetration": rest_penetration(box),
        # At 2 m/s no body is so fast that ``bounce_most`` holds it back.
        "restitution": box.restitution * box.matrix(0.0, box.dt)[4],
        "tunnelling_speed": tunnelling_speed(box),
        "deterministic": box.jitter == 0.0,
    }


def _determinant(box, h) -> float:
    a, b, _, c, d, _ = box.matrix(box.omega, h)
    return a * d - b * c


def radius_at(box, z) -> float:
    """Spectral radius of one spring step at h omega = z."""
    a, b, _, c, d, _ = box.matrix(box.omega, z / box.omega)
    half, det = (a + d) / 2, a * d - b * c
    root = half * half - det
    return math.sqrt(abs(det)) if root < 0 else abs(half) + math.sqrt(root)


def max_stable_step(box) -> float:
    """First loss of stability above 0.05/omega, s; every range is wider than the grid used here."""
    grid = [0.05 * k for k in range(1, 200)]
    unstable = next((z for z in grid if not radius_at(box, z) <= 1 + 1e-8), None)
    if unstable is None:
        return math.inf
    if unstable == grid[0]:
        return 0.0
    low, high = unstable - 0.05, unstable
    for _ in range(30):
        middle = (low + high) / 2
        low, high = (middle, high) if radius_at(box, middle) <= 1 + 1e-8 else (low, middle)
    return low / box.omega


def settled(box):
    """Where a body comes to rest, 5 s after it was put down touching."""
    q, _ = box.run("floor", [0.0, 0.0, box.radius], [0.0] * 3, box.dt, round(5 / box.dt), [0.0] * 3)
    return [float(x) for x in q[-1]]


def least_force(box, angle) -> float:
    """The least horizontal force in that direction that makes a settled body slide, N, to 1e-5."""
    start, n = settled(box), round(0.5 / box.dt)
    low, high = 0.0, 4 * box.mu * box.grip * box.mass * box.g
    while high - low > 1e-5 * high:
        force = (low + high) / 2
        push = [force * math.cos(angle), force * math.sin(angle), 0.0]
        _, v = box.run("floor", start, [0.0] * 3, box.dt, n, push)
        low, high = (low, force) if np.hypot(v[:, 0], v[:, 1]).max() > SLIP else (force, high)
    return high


def rest_penetration(box) -> float:
    """How deep it lies, m; bodies kept at a distance lie 0 deep."""
    return max(0.0, box.radius - settled(box)[2])


def tunnelling_speed(box) -> float:
    """The largest speed at which no start gets through, m/s.

    The engine sees a body in the samples that lie in a zone before (or around) the wall. The worst start
    puts one sample just short of the zone, and the body is through if its next move is as long as the zone.
    """
    if box.contact == "swept":
        return math.inf
    reach = box.radius + box.wall_thickness / 2 + box.margin
    zone = reach if box.contact == "nearest" else 2 * reach
    low, high = 0.0, FASTEST
    if not passes(box, high, reach, zone):
        return math.inf
    for _ in range(30):
        speed = (low + high) / 2
        low, high = (low, speed) if passes(box, speed, reach, zone) else (speed, high)
    return low


def passes(box, speed, reach, zone) -> bool:
    """Whether some start in [-1 - v dt, -1] has a sample just short of the zone and the next one beyond."""
    _, b, _, _, d, _ = box.matrix(0.0, box.dt)
    travelled, factor = 0.0, 1.0
    while travelled < 2 + speed * box.dt and factor > 1e-9:
        start = -reach - speed * travelled
        step = speed * factor * b
        if -1 - speed * box.dt <= start <= -1 and step >= zone:
            return True
        travelled += factor * b
        factor *= d
    return False
