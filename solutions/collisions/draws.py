"""Scenes of a grading run of ``collisions``, drawn from a seed. What public checks ask is in ``public.py``.

Exact grazes are never drawn, save where whole numbers make them exact: depths and misses keep a share of the
radii between themselves and zero.
"""

from __future__ import annotations

import math

import numpy as np

from course.scoring import kit

paths = kit.companion("collisions", "paths")
motions = kit.sibling(__file__, "motions")


def unit(rng, d):
    """A direction that is not near an axis (for d > 1), shape (d,)."""
    while True:
        n = rng.normal(size=d)
        n /= np.sqrt(n @ n)
        if d == 1 or np.min(np.abs(n)) > 0.15:
            return n


def across(rng, n):
    """A unit vector at right angles to n."""
    while True:
        s = rng.normal(size=len(n))
        s -= (s @ n) * n
        if np.sqrt(s @ s) > 0.2:
            return s / np.sqrt(s @ s)


def mass(rng):
    """kg, over a factor of a hundred."""
    return float(10 ** rng.uniform(-1.0, 1.0))


def masses(rng):
    """Two masses that are not nearly equal."""
    ma = mass(rng)
    return ma, float(ma * rng.uniform(1.5, 6.0) ** rng.choice([-1.0, 1.0]))


# -- detection ------------------------------------------------------------------------------------------


def spheres(rng, d, share):
    """Two spheres whose centres are ``share`` times the sum of the radii apart."""
    ra, rb = rng.uniform(0.1, 2.0, 2).tolist()
    xa = rng.uniform(-10.0, 10.0, d)
    return xa, ra, xa + share * (ra + rb) * unit(rng, d), rb


def plane(rng, d, height):
    """A sphere whose centre is ``height`` radii above a tilted plane."""
    r, n = rng.uniform(0.2, 2.0), unit(rng, d)
    point = rng.uniform(-5.0, 5.0, d)
    slide = rng.uniform(1.0, 4.0) * across(rng, n) if d > 1 else 0.0
    return point + height * r * n + slide, r, point, n


# -- impacts --------------------------------------------------------------------------------------------


def line(rng):
    """Two bodies on a line that approach, in any frame."""
    va = rng.uniform(-5.0, 5.0)
    return *masses(rng), float(va), float(va - rng.uniform(0.5, 6.0)), float(rng.uniform(0.15, 0.85))


def impact(rng, d, e=None):
    """Two bodies that approach along n and slide past each other across it."""
    ma, mb = masses(rng)
    n = unit(rng, d)
    va = rng.uniform(-4.0, 4.0, d)
    slip = rng.uniform(0.5, 3.0) * across(rng, n) if d > 1 else 0.0
    vb = va - rng.uniform(0.5, 6.0) * n + slip
    return ma, mb, va, vb, n, float(rng.uniform(0.15, 0.85)) if e is None else e


def friction(rng, d, share):
    """Like ``impact``, with friction ``share`` times what would stop the slip."""
    ma, mb, va, vb, n, e = impact(rng, d)
    closing = float((va - vb) @ n)
    slip = vb - va + closing * n
    mu = share * float(np.sqrt(slip @ slip)) / ((1 + e) * closing)
    return ma, mb, va, vb, n, e, mu


# -- the moment of contact ------------------------------------------------------------------------------


def shot(rng, speed):
    """A small ball shot at another, off centre, at this relative speed in m/s; it meets within the step."""
    n, dt = unit(rng, 3), 0.01
    ra, rb = rng.uniform(0.005, 0.02, 2).tolist()
    reach = ra + rb
    start = reach * 1.5 + rng.uniform(0.1, 0.7) * speed * dt
    xa, drift = rng.uniform(-3.0, 3.0, 3), rng.uniform(-2.0, 2.0, 3)
    xb = xa + start * n + rng.uniform(0.0, 0.6) * reach * across(rng, n)
    return xa, drift + speed * n, ra, xb, drift, rb, float(dt + 2 * reach / speed)


def nearly(rng, gap):
    """Two spheres with this gap, m, that approach so slowly that it takes them half a second."""
    n, (ra, rb) = unit(rng, 2), rng.uniform(0.2, 0.8, 2).tolist()
    xa, drift = rng.uniform(-1.0, 1.0, 2), rng.uniform(-1e-3, 1e-3, 2)
    return xa, drift + 2 * gap * n, ra, xa + (ra + rb + gap) * n, drift, rb, 1.0


def passing(rng, d, share):
    """Two spheres whose paths miss each other's centre by ``share`` times the sum of the radii.

    At the end of the step they are past each other; if the share is small, they are at their closest.
    """
    n = unit(rng, d)
    ra, rb = rng.uniform(0.2, 0.8, 2).tolist()
    reach, speed = ra + rb, rng.uniform(1.0, 5.0)
    start = reach * rng.uniform(2.0, 5.0)
    xa, drift = rng.uniform(-3.0, 3.0, d), rng.uniform(-2.0, 2.0, d)
    xb = xa + start * n + share * reach * across(rng, n)
    dt = start / speed * (1.0 if share < 0.5 else 2.0)
    return xa, drift + speed * n, ra, xb, drift, rb, float(dt)


def late(rng):
    """A pair that meets head on in the last hundredth of the step, both on their way at the same speed.

    So neither of them alone would come far enough.
    """
    xa, va, ra, xb, vb, rb, _ = passing(rng, 3, 0.0)
    va, vb = (va - vb) / 2, (vb - va) / 2
    meets = (float(np.linalg.norm(xb - xa)) - ra - rb) / float(np.linalg.norm(va - vb))
    return xa, va, ra, xb, vb, rb, meets * float(rng.uniform(1.001, 1.01))


def overlap(rng, approach):
    """Two spheres that overlap, approaching or parting."""
    n = unit(rng, 3)
    ra, rb = rng.uniform(0.2, 0.8, 2).tolist()
    xa, va = rng.uniform(-3.0, 3.0, 3), rng.uniform(-2.0, 2.0, 3)
    xb = xa + rng.uniform(0.3, 0.8) * (ra + rb) * n
    speed = rng.uniform(0.5, 3.0) * (-1.0 if approach else 1.0)
    return xa, va, ra, xb, va + speed * n + across(rng, n), rb, 1.0


def level(rng):
    """Spheres that overlap and come no nearer: with one centre, at one velocity, or moving at right angles.

    In whole numbers, so that x . v is exactly zero.
    """
    ra, rb = rng.uniform(2.0, 4.0, 2).tolist()
    xa, va, v = (rng.integers(-4, 5, 3).astype(float) for _ in range(3))
    a, b = rng.integers(1, 4, 2).tolist()
    turn = rng.permutation(3)
    apart, along = np.array([a, 0.0, -b])[turn] / 2, np.array([b, 2.0, a])[turn]
    pairs = ((xa, va + v + 0.5), (xa + apart, va), (xa + apart, va + along))
    return [(xa, va, ra, xb, vb, rb, 1.0) for xb, vb in pairs]


def same_meeting(rng, share):
    """One meeting four times: as it is, from a train, from elsewhere, exchanged."""
    xa, va, ra, xb, vb, rb, dt = passing(rng, 3, share)
    train, shift = rng.uniform(-50.0, 50.0, 3), rng.uniform(-50.0, 50.0, 3)
    return [
        (xa, va, ra, xb, vb, rb, dt),
        (xa, va + train, ra, xb, vb + train, rb, dt),
        (xa + shift, va, ra, xb + shift, vb, rb, dt),
        (xb, vb, rb, xa, va, ra, dt),
    ]


# -- simulations ----------------------------------------------------------------------------------------


def head_on(rng, kind):
    """A pair that meets between 0.3 and 0.8 s: plainly, with a wall, chasing, slowly; or one that parts."""
    m, radius = masses(rng), rng.uniform(0.1, 0.5)
    va = rng.uniform(0.5, 3.0)
    vb = {"chase": 0.3 * va, "part": 1.7 * va}.get(kind, -rng.uniform(0.5, 3.0))
    if kind == "slow":
        va, vb = 1e-4 * va, 1e-4 * vb
    if kind.startswith("wall"):
        m = (math.inf, m[1]) if kind == "wall on the left" else (m[0], math.inf)
    gap = abs(va - vb) * rng.uniform(0.3, 0.8)
    left = rng.uniform(-4.0, 4.0)
    e = rng.uniform(0.2, 0.8)
    return paths.HeadOn(
        tuple(map(float, m)), (left, left + 2 * radius + gap), (float(va), float(vb)), float(radius), float(e)
    )


def fast_pair(rng, jump):
    """A pair that closes by ``jump`` diameters a step; scene, t_end and h."""
    h, radius, n = float(rng.uniform(0.02, 0.1)), float(rng.uniform(0.05, 0.2)), 12
    speed = jump * 2 * radius / h
    va = speed * rng.uniform(0.3, 0.6)
    # In mid-step, so that the balls overlap neither at the sample before nor at the one after.
    contact = (int(rng.integers(3, 7)) + rng.uniform(0.3, 0.5)) * h
    left = rng.uniform(-2.0, 2.0)
    places = (float(left), float(left + 2 * radius + speed * contact))
    scene = paths.HeadOn(
        masses(rng), places, (float(va), float(va - speed)), radius, float(rng.uniform(0.2, 0.8))
    )
    return scene, n * h, h


def awkward(rng, above=False):
    """A count n and a step h of whole milliseconds whose decimal n h / h misses n in floating point: it falls
    short of it, or lies above it."""
    while True:
        n, h = int(rng.integers(120, 200)), int(rng.integers(7, 40)) / 1000
        quotient = round(n * h, 3) / h
        if quotient > n if above else quotient < n:
            return n, h


def drop(rng, up):
    """A ball that is dropped (up 0) or thrown upwards or downwards; scene, t_end and h."""
    g, radius = float(rng.uniform(1.6, 25.0)), float(rng.uniform(0.05, 0.3))
    z0 = radius + rng.uniform(0.5, 3.0)
    v0 = up * rng.uniform(1.0, 4.0)
    scene = paths.Drop(float(z0), float(v0), radius, float(rng.uniform(0.45, 0.85)), g)
    first = float(motions.contacts(scene, 1e3, 1e-3)[0][0])
    h, n = float(rng.uniform(0.008, 0.012)) * first, 300
    return scene, n * h, h


def settling(rng, e):
    """A ball that comes to rest well before the end."""
    radius = float(rng.uniform(0.05, 0.3))
    scene = paths.Drop(radius + float(rng.uniform(0.3, 1.0)), float(rng.uniform(-1.0, 1.0)), radius, float(e))
    h = float(rng.uniform(0.008, 0.012))
    times, _ = motions.contacts(scene, 1e3, scene.g * h)
    return scene, round(float(times[-1]) / h + 60) * h, h


def settling_at_once(rng):
    """A ball that loses nothing and touches the floor first with 0.8 to 0.95 g h: there it rests.

    Without the rule it would hop on; the duration's quotient by h lies above the count of steps.
    """
    n, h = awkward(rng, above=True)
    radius, g = float(rng.uniform(0.05, 0.3)), float(rng.uniform(4.0, 15.0))
    high = float((rng.uniform(0.8, 0.95) * g * h) ** 2 / (2 * g))
    return paths.Drop(radius + high, 0.0, radius, 1.0, g), round(n * h, 3), h


def lying(rng):
    """A ball that lies on the floor from the start."""
    radius, h = float(rng.uniform(0.05, 0.3)), float(rng.uniform(0.008, 0.012))
    return paths.Drop(radius, 0.0, radius, float(rng.uniform(0.3, 1.0))), 40 * h, h


def elastic(rng):
    """A ball that loses nothing, for five to twenty bounces."""
    radius = float(rng.uniform(0.05, 0.3))
    scene = paths.Drop(radius + float(rng.uniform(0.3, 1.0)), 0.0, radius, 1.0)
    h = float(rng.uniform(0.01, 0.02))
    return scene, 500 * h, h


def barely_launched(rng):
    """A ball thrown upwards from the floor at little more than g h; scene, t_end and h."""
    radius, g, h = rng.uniform((0.05, 4.0, 0.01), (0.3, 15.0, 0.03)).tolist()
    return paths.Drop(radius, float(rng.uniform(1.1, 1.6)) * g * h, radius, 0.7, g), 20 * h, h


def launched(rng):
    """A ball thrown upwards from the floor on which it lies; scene, t_end and h."""
    radius, v0 = float(rng.uniform(0.05, 0.3)), float(rng.uniform(1.5, 4.0))
    scene = paths.Drop(radius, v0, radius, float(rng.uniform(0.45, 0.85)), float(rng.uniform(4.0, 15.0)))
    h = float(rng.uniform(0.008, 0.012)) * 2 * v0 / scene.g
    return scene, 250 * h, h


def short_hop(rng):
    """A ball thrown up from just above the floor, so slowly that it is back within the step."""
    radius, g, h = (
        float(rng.uniform(0.05, 0.3)),
        float(rng.uniform(4.0, 15.0)),
        float(rng.uniform(0.01, 0.03)),
    )
    high, up = (rng.uniform(0.05, 0.12), rng.uniform(0.1, 0.3)) * np.array([g * h * h, g * h])
    return paths.Drop(radius + float(high), float(up), radius, float(rng.uniform(0.45, 0.85)), g), 20 * h, h


def twice_in_a_step(rng):
    """A ball that touches early in the second step, too fast to rest, and again, to rest, before its end."""
    radius, g, h = (
        float(rng.uniform(0.05, 0.3)),
        float(rng.uniform(4.0, 15.0)),
        float(rng.uniform(0.01, 0.03)),
    )
    speed, contact = float(rng.uniform(1.05, 1.25)) * g * h, float(rng.uniform(1.05, 1.25)) * h
    z0 = radius + speed * contact - g * contact**2 / 2
    return paths.Drop(z0, g * contact - speed, radius, float(rng.uniform(0.15, 0.25)), g), 20 * h, h


def hopping(rng):
    """A ball that touches early in the second step, too fast to rest; at the end of that step it is slow."""
    radius, g, h = (
        float(rng.uniform(0.05, 0.3)),
        float(rng.uniform(4.0, 15.0)),
        float(rng.uniform(0.01, 0.03)),
    )
    speed, contact = float(rng.uniform(1.25, 1.6)) * g * h, float(rng.uniform(1.05, 1.2)) * h
    z0 = radius + speed * contact - g * contact**2 / 2
    return paths.Drop(z0, g * contact - speed, radius, float(rng.uniform(0.9, 0.97)), g), 20 * h, h


def slim(rng):
    """A pair whose radii, in m, are smaller than the step, in s, and the time to the contact within it."""
    h, radius = float(rng.uniform(0.15, 0.3)), float(rng.uniform(0.01, 0.03))
    va, vb = rng.uniform((0.5, -2.0), (2.0, -0.5)).tolist()
    contact = (int(rng.integers(3, 7)) + rng.uniform(0.3, 0.7)) * h
    left = float(rng.uniform(-2.0, 2.0))
    places = left, left + 2 * radius + (va - vb) * contact
    return paths.HeadOn(masses(rng), places, (va, vb), radius, float(rng.uniform(0.2, 0.8))), 12 * h, h


def early(rng):
    """A pair that meets within the first step, for a duration whose quotient by h lies above a count."""
    n, h = awkward(rng, above=True)
    radius, va, vb = rng.uniform((0.1, 0.5, -2.0), (0.5, 2.0, -0.5)).tolist()
    left = float(rng.uniform(-4.0, 4.0))
    gap = (va - vb) * h * float(rng.uniform(0.2, 0.8))
    places = left, left + 2 * radius + gap
    scene = paths.HeadOn(masses(rng), places, (va, vb), radius, float(rng.uniform(0.2, 0.8)))
    return scene, round(n * h, 3), h


def touching(rng):
    """A pair that touches exactly and approaches: the impact comes at once."""
    radius, (va, vb) = 0.25, rng.uniform((0.5, -2.0), (2.0, -0.5)).tolist()
    left = float(rng.integers(-4, 5)) / 2
    places = left, left + 2 * radius
    return paths.HeadOn(masses(rng), places, (va, vb), radius, float(rng.uniform(0.2, 0.8))), 0.5, 0.05


def on_sample(rng):
    """A pair that meets at a sample, the time of which has by ``%`` nearly a step left and by ``/`` none."""
    while True:
        h, k = float(rng.integers(10, 60)) / 1000, int(rng.integers(5, 60))
        (va, vb), radius = rng.integers((1, -4), (5, 0)).tolist(), float(rng.integers(2, 10)) / 20
        left = float(rng.integers(-8, 9)) / 2
        places = left, left + 2 * radius + (va - vb) * h * k
        scene = paths.HeadOn(masses(rng), places, (float(va), float(vb)), radius, 0.5)
        contact = motions.meeting(scene).contact
        if int(contact / h) == k and contact % h > h / 2:
            return scene, round((k + 20) * h, 3), h


# -- exact and slow, where limits show ------------------------------------------------------------------


def near_centres(rng):
    """Two spheres whose centres are a hundredth of a millimetre apart, and do not coincide.

    They are so far from the origin that a relative tolerance takes all coordinates for the same.
    """
    _, ra, _, rb = spheres(rng, 3, 1.0)
    xa = rng.uniform(4.0, 10.0, 3) * rng.choice([-1.0, 1.0], 3)
    return xa, ra, xa + 10 ** rng.uniform(-5.2, -4.5) * unit(rng, 3), rb


def exact_spheres(rng, gap):
    """Two spheres that touch exactly, in whole numbers (3-4-5); or with a gap of so many metres."""
    xa = rng.integers(-5, 6, 3).astype(float)
    apart = rng.permutation([3.0, 4.0, 0.0]) * rng.choice([-1.0, 1.0], 3)
    ra = float(rng.integers(1, 5))
    return xa, ra, xa + apart, 5.0 - ra - gap


def touching_spheres(rng):
    """Two spheres that touch exactly, in whole numbers, and approach."""
    xa, ra, xb, rb = exact_spheres(rng, 0.0)
    return xa, xb - xa, ra, xb, np.zeros(len(xa)), rb, 1.0


def exact_plane(rng, gap):
    """A sphere that touches a plane along an axis exactly; or with a gap of so many metres."""
    axis, side = int(rng.integers(0, 3)), float(rng.choice([-1.0, 1.0]))
    n = side * np.eye(3)[axis]
    point, r = rng.integers(-5, 6, 3).astype(float), float(rng.integers(1, 5)) / 2
    slide = rng.integers(-3, 4, 3).astype(float)
    slide[axis] = 0.0
    return point + slide + r * n, r - gap, point, n


def gap(rng):
    """Ten nanometres to a micrometre, which every margin takes for a touch; in m."""
    return float(10 ** rng.uniform(-8.0, -6.0))


def slow(rng, d):
    """Two bodies that approach at less than 1 mm/s: below every limit at which engines drop the rebound."""
    ma, mb, va, _, n, e = impact(rng, d)
    speed = 10 ** rng.uniform(-3.7, -3.2)
    return ma, mb, va, va - speed * n, n, e


def slow_line(rng):
    """The same on a line, from a train so fast that a relative tolerance takes both speeds for one."""
    ma, mb, _, _, e = line(rng)
    va = float(rng.choice([-1, 1]) * rng.uniform(70.0, 100.0))
    return ma, mb, va, va - float(10 ** rng.uniform(-3.7, -3.2)), e


def creeping(rng, stays=False):
    """An impact with friction in which the bodies slide past each other at less than a mm/s, until friction
    stops that; or, where it ``stays``, with too little friction to stop even that."""
    ma, mb, va, vb, n, e = impact(rng, 3)
    slip, closing = 10 ** rng.uniform(-3.7, -3.2), float((va - vb) @ n)
    mu = float(rng.uniform(0.3, 0.7) * slip / ((1 + e) * closing) if stays else rng.uniform(0.2, 0.6))
    return ma, mb, va, va - closing * n + slip * across(rng, n), n, e, mu


def alike(rng, args):
    """The same two bodies with masses that differ by less than 1 %."""
    return args[0], args[0] * float(1 + rng.uniform(0.002, 0.009)), *args[2:]


def twins(rng, args):
    """The same two bodies with masses that differ by less than a hundred thousandth."""
    return args[0], args[0] * float(1 + 10 ** rng.uniform(-5.9, -5.1)), *args[2:]


def even(rng, args):  # noqa: ARG001 - called like the others
    """The same two bodies with one and the same mass."""
    return args[0], args[0], *args[2:]


def exchange(rng):
    """Two equal masses without loss, which exchange their velocities along the normal and nothing else."""
    ma, _, *rest = impact(rng, 3, 1.0)
    return ma, ma, *rest


def heavy(rng, args):
    """The same two bodies, one of them so heavy that it is nearly a wall."""
    return args[0], args[0] * float(10 ** rng.uniform(4.2, 6.0)), *args[2:]


#: Pairs of masses that are equal, nearly equal or very unequal, as the README promises.
MASSES = (even, alike, twins, heavy)


def ends(args):
    """The same impact without a rebound, and with all of it."""
    at = 4 if len(args) == 5 else 5  # after the normal, if there is one
    return [(*args[:at], e, *args[at + 1 :]) for e in (0.0, 1.0)]


def at_rest(args, side):
    """The same impact, seen by one of the bodies."""
    ma, mb, va, vb, *rest = args
    seen_by = (va, vb)[side]
    return ma, mb, va - seen_by, vb - seen_by, *rest


def parting(args):
    """The same two bodies, moving apart."""
    ma, mb, va, vb, *rest = args
    return ma, mb, vb, va, *rest


def opposed(args):
    """The same two bodies, seen from where one moves as fast as the other, the opposite way."""
    ma, mb, va, vb, *rest = args
    middle = (va + vb) / 2
    return ma, mb, va - middle, vb - middle, *rest


def wall(args, side):
    """The same impact with one mass infinite."""
    return (math.inf, *args[1:]) if side else (args[0], math.inf, *args[2:])


def chased(rng, args, side):
    """The same impact where one body (b for side 0, a for side 1) moves off and the other one follows."""
    _, _, va, vb, n, *_ = args
    closing = float((va - vb) @ n)
    slow = -va @ n - closing * rng.uniform(0.2, 0.6) if side else -vb @ n + closing * rng.uniform(0.2, 0.6)
    return *args[:2], va + slow * n, vb + slow * n, *args[4:]


def rough(rng):
    """An impact on a surface so rough (mu above one) that it still slides."""
    ma, mb, va, vb, n, e = impact(rng, 3, 0.3)
    closing, mu = float((va - vb) @ n), float(rng.uniform(1.5, 3.0))
    slip = float(rng.uniform(1.5, 3.0)) * mu * (1 + e) * closing * across(rng, n)
    return ma, mb, va, va - closing * n + slip, n, e, mu


def carried(rng, call, way):
    """The same pair on a fast train that goes along the normal, or against it (``way`` 1.0 or -1.0)."""
    ma, mb, va, vb, n, *rest = call
    train = way * float(rng.uniform(8.0, 12.0)) * n
    return ma, mb, va + train, vb + train, n, *rest
