"""What the public checks of ``collisions`` ask in a grading run: scenes of the same kind as at home."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from course.scoring import kit

paths = kit.companion("collisions", "paths")
draws = kit.sibling(__file__, "draws")
motions = draws.motions


def _never(rng):
    meets = draws.passing(rng, 3, 0.4)
    xa, va, ra, xb, vb, rb, dt = meets
    overlaps = [draws.overlap(rng, approach) for approach in (True, False)]
    return [
        draws.passing(rng, 3, 1.5),
        (xa, vb, ra, xb, va, rb, dt),
        (xa, va, ra, xb, va, rb, dt),
        (xa, va, ra, xb, vb, rb, 0.1 * dt),
        meets,
        (xa, va, ra, xb, vb, rb, 3 * dt),
        *overlaps,
        *draws.level(rng),
    ]


def _no_friction(rng):
    smooth = (*draws.impact(rng, 3), 0.0)
    # Along an axis and in whole numbers the slip is exactly zero.
    axis, side = int(rng.integers(0, 3)), float(rng.choice([-1.0, 1.0]))
    n, va = side * np.eye(3)[axis], rng.integers(-4, 5, 3).astype(float)
    straight = (
        *draws.masses(rng),
        va,
        va - float(rng.integers(1, 6)) * n,
        n,
        float(rng.uniform(0.2, 0.8)),
        0.4,
    )
    apart = [draws.carried(rng, draws.parting(draws.friction(rng, 3, 0.6)), way) for way in (1.0, -1.0)]
    apart.append(draws.opposed(draws.parting(draws.friction(rng, 3, 0.6))))
    return [smooth, straight, *apart, draws.friction(rng, 3, 0.6)]


def _mended(rng):
    some = [(draws.head_on(rng, "meet"), float(rng.uniform(0.006, 0.02))) for _ in range(3)]
    ends = (1.0, some[1][0].restitution, 0.0)
    pairs = [(replace(scene, restitution=e), h) for (scene, h), e in zip(some, ends, strict=True)]
    pairs += [(draws.head_on(rng, kind), float(rng.uniform(0.006, 0.02))) for kind in ("chase", "slow")]
    cases = [(scene, 150 * h, h) for scene, h in pairs]
    # The first one again: nothing that an earlier call left behind may count.
    return [*cases, draws.early(rng), cases[0]]


def _beside_pymunk(rng):
    scene, h = draws.head_on(rng, "meet"), float(rng.uniform(0.004, 0.01))
    return [(scene, 200 * h, h)]


def _fall_beside_pymunk(rng):
    scene, h = paths.Drop(float(rng.uniform(0.8, 1.5)), 0.0, 0.1, float(rng.uniform(0.5, 0.8))), 0.002
    first, second = motions.contacts(scene, 10.0, 0.5)[0][:2]
    return [(scene, int((0.3 * first + 0.7 * second) / h) * h, h)]


def _decimal(rng):
    n, h = draws.awkward(rng)
    scene = draws.drop(rng, 0.0)[0]
    return scene, round(n * h, 3), h


#: What each public check asks in a grading run.
PUBLIC = {
    "sphere_contact": lambda rng: [
        *(draws.spheres(rng, d, share) for d, share in ((3, 0.6), (3, 1.8), (2, 0.85))),
        draws.exact_spheres(rng, 0.0),
        draws.exact_spheres(rng, draws.gap(rng)),
        draws.near_centres(rng),
    ],
    "plane_contact": lambda rng: [
        *(draws.plane(rng, d, height) for d, height in ((3, 0.6), (3, 2.5), (3, -0.8), (2, 0.5))),
        draws.exact_plane(rng, 0.0),
        draws.exact_plane(rng, draws.gap(rng)),
    ],
    "impulse_value": lambda rng: [
        *(draws.line(rng) for _ in range(3)),
        draws.slow_line(rng),
        *draws.ends(draws.line(rng)),
        *(change(rng, draws.line(rng)) for change in draws.MASSES),
    ],
    "impulse_separating": lambda rng: [
        *(draws.parting(draws.line(rng)) for _ in range(3)),
        draws.opposed(draws.parting(draws.line(rng))),
        draws.parting(draws.slow_line(rng)),
        draws.line(rng),
    ],
    "impulse_walls": lambda rng: [draws.wall(draws.line(rng), side) for side in (0, 1)],
    "resolve_oblique": lambda rng: [
        *(draws.impact(rng, d) for d in (3, 3, 2)),
        draws.slow(rng, 2),
        draws.exchange(rng),
        *(change(rng, draws.impact(rng, 3)) for change in draws.MASSES),
    ],
    "resolve_separating": lambda rng: [
        *(draws.carried(rng, draws.parting(draws.impact(rng, d)), way) for d, way in ((3, 1.0), (2, -1.0))),
        draws.opposed(draws.parting(draws.impact(rng, 3))),
        draws.parting(draws.slow(rng, 3)),
        draws.impact(rng, 3),
    ],
    "resolve_walls": lambda rng: [
        draws.wall(draws.chased(rng, draws.impact(rng, d), side), side) for d, side in ((2, 0), (3, 1))
    ],
    "friction_regimes": lambda rng: [
        *(draws.friction(rng, d, share) for d, share in ((3, 0.3), (3, 0.7), (3, 1.1), (3, 5.0), (2, 0.6))),
        draws.rough(rng),
        draws.creeping(rng),
        *(change(rng, draws.friction(rng, 3, 0.5)) for change in draws.MASSES),
    ],
    "friction_absent": _no_friction,
    "friction_walls": lambda rng: [
        draws.wall(draws.chased(rng, draws.friction(rng, d, 0.6), side), side) for d, side in ((2, 0), (3, 1))
    ],
    "moment_of_contact": lambda rng: [
        draws.late(rng),
        draws.shot(rng, 300.0),
        # Beyond the larger radius, and within it.
        draws.passing(rng, 3, 0.95),
        draws.passing(rng, 2, 0.4),
        draws.shot(rng, float(10 ** rng.uniform(-2.7, -2.2))),
    ],
    "moment_never": _never,
    "head_on_mended": _mended,
    "head_on_pymunk": _beside_pymunk,
    "drop_bounces": lambda rng: [
        draws.drop(rng, 0.0),
        draws.drop(rng, 1.0),
        draws.launched(rng),
        _decimal(rng),
        draws.short_hop(rng),
        draws.settling_at_once(rng),
    ],
    "drop_pymunk": _fall_beside_pymunk,
    "sphere_kept": lambda rng: [draws.spheres(rng, 3, 0.6)],
    "plane_kept": lambda rng: [draws.plane(rng, 3, 0.6)],
    "resolve_kept": lambda rng: [draws.impact(rng, 3)],
    "friction_kept": lambda rng: [draws.friction(rng, 3, 0.6)],
    "moment_kept": lambda rng: [draws.passing(rng, 3, 0.6)],
    "head_on_kept": lambda rng: [draws.early(rng)],
}
