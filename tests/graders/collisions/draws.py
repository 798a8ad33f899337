"""Scenes for the hidden graders of ``collisions``, drawn from a seed.

Exact grazes are never drawn: depths and misses keep a share of the radii between themselves and zero.
"""

from __future__ import annotations

import math

import numpy as np

from course.grading import kit

bundles = kit.companion("collisions", "bundles")
paths = bundles.paths


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
    return point + height * r * n + rng.uniform(1.0, 4.0) * across(rng, n), r, point, n


# -- blows ----------------------------------------------------------------------------------------------


def line(rng):
    """Two bodies on a line that approach, in any frame."""
    va = rng.uniform(-5.0, 5.0)
    return *masses(rng), float(va), float(va - rng.uniform(0.5, 6.0)), float(rng.uniform(0.15, 0.85))


def blow(rng, d, e=None):
    """Two bodies that approach along n and slide past each other across it."""
    ma, mb = masses(rng)
    n = unit(rng, d)
    va = rng.uniform(-4.0, 4.0, d)
    slip = rng.uniform(0.5, 3.0) * across(rng, n) if d > 1 else 0.0
    vb = va - rng.uniform(0.5, 6.0) * n + slip
    return ma, mb, va, vb, n, float(rng.uniform(0.15, 0.85)) if e is None else e


def rub(rng, d, share):
    """Like ``blow``, with friction ``share`` times what would stop the slip."""
    ma, mb, va, vb, n, e = blow(rng, d)
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


def overlap(rng, approach):
    """Two spheres that overlap, approaching or parting."""
    n = unit(rng, 3)
    ra, rb = rng.uniform(0.2, 0.8, 2).tolist()
    xa, va = rng.uniform(-3.0, 3.0, 3), rng.uniform(-2.0, 2.0, 3)
    xb = xa + rng.uniform(0.3, 0.8) * (ra + rb) * n
    speed = rng.uniform(0.5, 3.0) * (-1.0 if approach else 1.0)
    return xa, va, ra, xb, va + speed * n + across(rng, n), rb, 1.0


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
    """A pair that meets between 0.3 and 0.8 s, one with a wall, one that chases, or one that never meets."""
    m, radius = masses(rng), rng.uniform(0.1, 0.5)
    va = rng.uniform(0.5, 3.0)
    vb = {"chase": 0.3 * va, "part": 1.7 * va}.get(kind, -rng.uniform(0.5, 3.0))
    if kind == "wall":
        m = (m[0], math.inf)
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


def awkward(rng):
    """A count n and a step h of whole milliseconds whose decimal n h / h falls short of n in "
    "floating point."""
    while True:
        n, h = int(rng.integers(120, 200)), int(rng.integers(7, 40)) / 1000
        if round(n * h, 3) / h < n:
            return n, h


def drop(rng, up):
    """A ball that is dropped (up 0) or thrown upwards or downwards; scene, t_end and h."""
    g, radius = float(rng.uniform(1.6, 25.0)), float(rng.uniform(0.05, 0.3))
    z0 = radius + rng.uniform(0.5, 3.0)
    v0 = up * rng.uniform(1.0, 4.0)
    scene = paths.Drop(float(z0), float(v0), radius, float(rng.uniform(0.45, 0.85)), g)
    first = float(scene.contacts(1e3, 1e-3)[0][0])
    h, n = float(rng.uniform(0.008, 0.012)) * first, 300
    return scene, n * h, h


def settling(rng, e):
    """A ball that comes to rest well before the end."""
    radius = float(rng.uniform(0.05, 0.3))
    scene = paths.Drop(radius + float(rng.uniform(0.3, 1.0)), float(rng.uniform(-1.0, 1.0)), radius, float(e))
    h = float(rng.uniform(0.008, 0.012))
    times, _ = scene.contacts(1e3, scene.g * h)
    return scene, round(float(times[-1]) / h + 60) * h, h


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
