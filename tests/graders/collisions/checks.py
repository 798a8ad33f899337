"""Hidden graders of ``collisions``. Scenes are drawn anew from the seed of each grading run.

What correct solutions leave of each tolerance is in ``tests/benchmarks/calibration/collisions.md``.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from course.scoring import kit

bundles = kit.companion("collisions", "bundles")
draws = kit.reference("collisions", "draws")
laws = kit.sibling(__file__, "laws")
probes = bundles.probes

# -- detection ------------------------------------------------------------------------------------------


@pytest.mark.task(bundles.SPHERES)
@pytest.mark.points(4)
def test_sphere_contact_drawn(submission, rng):
    """Spheres anywhere, in one, two and three dimensions, apart and overlapping"""
    bundles.expect_formula(
        submission,
        bundles.SPHERES,
        [
            *(draws.spheres(rng, d, share) for d in (1, 2, 3) for share in (0.4, 0.9, 1.1, 2.5)),
            *(draws.exact_spheres(rng, gap) for gap in (0.0, draws.gap(rng), -draws.gap(rng))),
            draws.near_centres(rng),
        ],
        "Touching, normal or depth of two spheres is wrong.",
        "All of it follows from the vector from a to b, its length and the two radii.",
    )
    bundles.expect_kept(submission, bundles.SPHERES, draws.spheres(rng, 3, 0.8))


@pytest.mark.task(bundles.SPHERES)
@pytest.mark.points(2)
def test_sphere_same_centre(submission, rng):
    """Spheres with the same centre"""
    bundles.expect_one_centre(submission, [draws.spheres(rng, d, 0.0) for d in (2, 3)])


@pytest.mark.task(bundles.PLANE)
@pytest.mark.points(3)
def test_plane_contact_drawn(submission, rng):
    """Spheres and planes anywhere, most of them tilted"""
    bundles.expect_formula(
        submission,
        bundles.PLANE,
        [
            *(draws.plane(rng, d, height) for d in (1, 2, 3) for height in (0.3, 0.95, 1.05, 3.0)),
            *(draws.exact_plane(rng, gap) for gap in (0.0, draws.gap(rng), -draws.gap(rng))),
        ],
        "Touching, normal or depth of a sphere and a plane is wrong.",
        "Only the height above the plane counts, the part of x - point along the normal: the depth is r less "
        "that. The normal is the one given.",
    )
    bundles.expect_kept(submission, bundles.PLANE, draws.plane(rng, 3, 0.8))


@pytest.mark.task(bundles.PLANE)
@pytest.mark.points(2)
def test_plane_below(submission, rng):
    """A sphere whose centre is already below the plane"""
    bundles.expect_formula(
        submission,
        bundles.PLANE,
        [draws.plane(rng, 3, height) for height in (-0.2, -0.9, -1.5, -6.0)],
        "For a centre on the solid side of the plane the result is wrong.",
        "The solid is all of the half-space. The height is that of the centre along the normal, negative "
        "below the plane, the depth is r less the height, and the normal is the one given.",
    )


# -- an impact on a line -----------------------------------------------------------------------------------


@pytest.mark.task(bundles.IMPULSE)
@pytest.mark.points(3)
def test_impulse_drawn(submission, rng):
    """The impulse for any masses, speeds and restitution"""
    bundles.expect_formula(
        submission,
        bundles.IMPULSE,
        [
            *(draws.line(rng) for _ in range(6)),
            *(draws.slow_line(rng) for _ in range(3)),
            *draws.ends(draws.line(rng)),
            *draws.ends(draws.alike(rng, draws.line(rng))),
            *(change(rng, draws.line(rng)) for change in draws.MASSES),
            *(draws.at_rest(draws.line(rng), side) for side in (0, 1)),
        ],
        "The impulse of two bodies on a line is wrong.",
        "Test it yourself: momentum kept, and the speed of parting e times the speed of approach.",
    )


@pytest.mark.task(bundles.IMPULSE)
@pytest.mark.points(2)
def test_impulse_symmetries(submission, rng):
    """The impulse seen from a moving train, in a mirror, and with a and b swapped"""
    laws.expect_line_symmetries(submission, rng)


@pytest.mark.task(bundles.IMPULSE)
@pytest.mark.points(2)
def test_impulse_wall(submission, rng):
    """The impulse against a body of infinite mass, on either side"""
    calls = []
    for side in (0, 1, 0, 1):
        ma, mb, va, vb, e = draws.line(rng)
        calls.append((math.inf, mb, va, vb, e) if side else (ma, math.inf, va, vb, e))
    bundles.expect_formula(
        submission,
        bundles.IMPULSE,
        calls,
        "The impulse on a body that meets a wall (a body of infinite mass) is wrong.",
        bundles.WALLS[bundles.IMPULSE],
    )


# -- an impact in space ------------------------------------------------------------------------------------


@pytest.mark.task(bundles.RESOLVE)
@pytest.mark.points(2)
def test_resolve_momentum(submission, rng):
    """The total momentum of an impact"""
    laws.expect_momentum(
        submission,
        bundles.RESOLVE,
        [
            *(draws.impact(rng, d) for d in (2, 2, 3, 3)),
            draws.alike(rng, draws.impact(rng, 3)),
            *draws.ends(draws.alike(rng, draws.impact(rng, 3))),
        ],
    )


@pytest.mark.task(bundles.RESOLVE)
@pytest.mark.points(2)
def test_resolve_parting(submission, rng):
    """How bodies part: along the normal and across it"""
    calls = [*(draws.impact(rng, d) for d in (1, 2, 3, 3, 3)), *(draws.slow(rng, 3) for _ in range(3))]
    calls += [draws.exchange(rng), draws.heavy(rng, draws.impact(rng, 3))]
    calls += [change(rng, draws.impact(rng, 3)) for change in (draws.even, draws.twins)]
    laws.expect_parting(submission, calls)


@pytest.mark.task(bundles.RESOLVE)
@pytest.mark.points(2)
def test_resolve_energy(submission, rng):
    """The energy that an impact costs"""
    laws.expect_energy(submission, [draws.impact(rng, 3, e) for e in (1.0, 1.0, 0.0, None, None)])


@pytest.mark.task(bundles.RESOLVE)
@pytest.mark.points(2)
def test_resolve_symmetries(submission, rng):
    """An impact seen from a moving train, rotated, mirrored, and with a and b swapped"""
    laws.expect_symmetries(submission, bundles.RESOLVE, rng)


@pytest.mark.task(bundles.RESOLVE)
@pytest.mark.points(2)
def test_resolve_wall(submission, rng):
    """An impact against a body of infinite mass"""
    laws.expect_wall(submission, bundles.RESOLVE, rng)


@pytest.mark.task(bundles.RESOLVE)
@pytest.mark.points(2)
def test_resolve_inputs(submission, rng):
    """One impact: the velocities after it, and the arguments"""
    laws.expect_clean(submission, bundles.RESOLVE, rng)


# -- friction -------------------------------------------------------------------------------------------


@pytest.mark.task(bundles.FRICTION)
@pytest.mark.points(3)
def test_friction_cone(submission, rng):
    """How large friction is, in every direction"""
    bundles.expect_formula(
        submission,
        bundles.FRICTION,
        [
            *(draws.friction(rng, d, share) for d in (2, 3, 3) for share in (0.3, 0.8, 1.1, 4.0)),
            draws.rough(rng),
            (*draws.slow(rng, 3), 0.3),
            draws.creeping(rng),
            draws.creeping(rng, stays=True),
            *(change(rng, draws.friction(rng, 3, 0.5)) for change in draws.MASSES),
            *draws.ends(draws.friction(rng, 3, 0.5)),
        ],
        "The velocities after an impact with friction are wrong.",
        "Along the normal acts J, as in `resolve`. Across it the slip is a vector: its length decides which "
        "limit of friction holds, and its direction where friction points.",
    )


@pytest.mark.task(bundles.FRICTION)
@pytest.mark.points(2)
def test_friction_energy(submission, rng):
    """Friction: momentum, energy and slip"""
    laws.expect_braking(submission, [draws.friction(rng, 3, share) for share in (0.4, 0.7, 2.0, 4.0)])


@pytest.mark.task(bundles.FRICTION)
@pytest.mark.points(2)
def test_friction_symmetries(submission, rng):
    """An impact with friction from a moving train, rotated, mirrored, with a and b swapped"""
    laws.expect_symmetries(submission, bundles.FRICTION, rng)


@pytest.mark.task(bundles.FRICTION)
@pytest.mark.points(2)
def test_friction_wall(submission, rng):
    """A rough wall that moves"""
    laws.expect_wall(submission, bundles.FRICTION, rng)


@pytest.mark.task(bundles.FRICTION)
@pytest.mark.points(1)
def test_friction_inputs(submission, rng):
    """One impact with friction: the velocities after it, and the arguments"""
    laws.expect_clean(submission, bundles.FRICTION, rng)


# -- the moment of contact ------------------------------------------------------------------------------


@pytest.mark.task(bundles.MOMENT)
@pytest.mark.points(3)
def test_moment_any_speed(submission, rng):
    """The moment of contact at any speed"""
    bundles.expect_formula(
        submission,
        bundles.MOMENT,
        [
            *(draws.shot(rng, 10.0**power) for power in (*np.linspace(0.0, 5.0, 11), -2.4, -3.1)),
            draws.late(rng),
            *(draws.nearly(rng, gap) for gap in (1e-3, 1e-4, 3e-6)),
        ],
        "A contact is missed or comes at the wrong time.",
        "At any speed the first moment of contact is the smaller root of the quadratic, if it is at most dt; "
        "nothing needs to be sampled.",
    )


@pytest.mark.task(bundles.MOMENT)
@pytest.mark.points(3)
def test_moment_oblique(submission, rng):
    """Spheres that meet off centre, and spheres that miss"""
    bundles.expect_formula(
        submission,
        bundles.MOMENT,
        [draws.passing(rng, d, share) for d in (2, 3) for share in (0.3, 0.7, 0.9, 1.1, 1.8)],
        "Where two spheres meet off centre or pass each other, the result is wrong.",
        "Off centre they touch later than head on. If they pass at more than ra + rb, they do not touch.",
    )
    bundles.expect_kept(submission, bundles.MOMENT, draws.passing(rng, 3, 0.6))


@pytest.mark.task(bundles.MOMENT)
@pytest.mark.points(1)
def test_moment_overlap(submission, rng):
    """Spheres that overlap from the start, or touch"""
    bundles.expect_formula(
        submission,
        bundles.MOMENT,
        [
            *(draws.overlap(rng, approach) for approach in (True, False, True, False)),
            *draws.level(rng),
            draws.touching_spheres(rng),
        ],
        "For spheres that overlap or touch at the start the result is wrong.",
        "If they approach, the answer is 0.0. Otherwise it is None.",
    )


@pytest.mark.task(bundles.MOMENT)
@pytest.mark.points(1)
def test_moment_symmetries(submission, rng):
    """The moment of contact from a moving train, from elsewhere, and with a and b swapped"""
    calls = [call for share in (0.4, 0.8) for call in draws.same_meeting(rng, share)]
    bundles.expect_formula(
        submission,
        bundles.MOMENT,
        calls,
        "One meeting is asked four times (as it is, from a moving train, from elsewhere, with a and b "
        "exchanged), and a time is wrong.",
        "The right time is the same in all four, for it depends on differences alone: of the two places and "
        "of the two velocities.",
    )


# -- simulations ----------------------------------------------------------------------------------------


@pytest.mark.task(bundles.HEAD_ON)
@pytest.mark.points(3)
def test_head_on_drawn(submission, rng):
    """Balls of any masses, some of which never meet"""
    scenes = [
        draws.head_on(rng, kind) for kind in ("meet", "chase", "wall", "wall on the left", "slow", "part")
    ]
    scenes.append(scenes[0])  # nothing that an earlier call left behind may count
    h, n = rng.uniform(0.01, 0.03), 120
    values = submission.call_each(bundles.HEAD_ON, [scene.args(n * h, h) for scene in scenes])
    truths = bundles.meetings([(scene, n * h, h) for scene in scenes])
    for scene, truth, value in zip(scenes, truths, values, strict=True):
        bundles.expect_head_on(
            scene,
            truth,
            value,
            n * h,
            h,
            "Two balls on a line do not move as they should.",
            "Straight lines, one impact at the instant when the surfaces touch, straight lines.",
        )


@pytest.mark.task(bundles.HEAD_ON)
@pytest.mark.points(2)
def test_head_on_large_steps(submission, rng):
    """Fast balls, long steps, and meetings in the first step and on a sample"""
    cases = [*(draws.fast_pair(rng, jump) for jump in (3.0, 30.0, 1000.0)), draws.early(rng), draws.slim(rng)]
    cases += [draws.touching(rng), draws.on_sample(rng)]
    values = submission.call_each(bundles.HEAD_ON, [scene.args(t_end, h) for scene, t_end, h in cases])
    for (scene, t_end, h), truth, value in zip(cases, bundles.meetings(cases), values, strict=True):
        bundles.expect_head_on(
            scene,
            truth,
            value,
            t_end,
            h,
            "Balls that meet early or on a sample, or travel far in one step, do not move as they should.",
            "The contact lies inside the step, gap over speed of approach after its start. Straight lines up "
            "to it, the impact, straight lines for the rest of the step.",
        )


@pytest.mark.task(bundles.HEAD_ON)
@pytest.mark.points(1)
def test_head_on_samples(submission, rng):
    """The head-on program's samples for awkward durations, and its arguments"""
    scene = draws.head_on(rng, "meet")
    n, h = draws.awkward(rng)
    t_end = round(n * h, 3)
    args = scene.args(t_end, h)
    inspected = submission.call_inspect(bundles.HEAD_ON, *args)
    bundles.expect_head_on(
        scene,
        bundles.meetings([(scene, t_end, h)])[0],
        inspected.value,
        t_end,
        h,
        "For a duration whose quotient by h is not exact, the balls do not move as they should.",
        "Row 0 is the initial state. Then straight lines, one impact at the instant when the surfaces touch, "
        "straight lines.",
    )
    kit.expect_untouched(
        args,
        replace(inspected, shared=False),  # a list may begin with x0 itself
        names=["m", "x0", "v0", "", "", "", ""],
        mutated=bundles.named("MUTATES_INPUT"),
        shared=bundles.named("MUTATES_INPUT"),
    )


@pytest.mark.task(bundles.DROP)
@pytest.mark.points(3)
def test_drop_drawn(submission, rng):
    """Balls dropped and thrown, on this planet and others"""
    cases = [*(draws.drop(rng, up) for up in (0.0, 1.0, -1.0)), draws.launched(rng), draws.short_hop(rng)]
    cases.append(draws.barely_launched(rng))
    values = submission.call_each(bundles.DROP, [scene.args(t_end, h) for scene, t_end, h in cases])
    for (scene, t_end, h), truth, value in zip(cases, bundles.bounces(cases), values, strict=True):
        bundles.expect_drop(
            scene,
            truth,
            value,
            t_end,
            h,
            "A bouncing ball does not move as it should.",
            "Parabolas that meet at the floor, each starting with e times the speed at which the last ended.",
        )


@pytest.mark.task(bundles.DROP)
@pytest.mark.points(2)
def test_drop_rest(submission, rng):
    """A ball that comes to rest, and one that lies on the floor"""
    cases = [draws.settling(rng, e) for e in (rng.uniform(0.2, 0.6), 0.0)]
    cases += [
        draws.settling_at_once(rng),
        draws.lying(rng),
        draws.twice_in_a_step(rng),
        draws.hopping(rng),
    ]
    values = submission.call_each(bundles.DROP, [scene.args(t_end, h) for scene, t_end, h in cases])
    for (scene, t_end, h), truth, value in zip(cases, bundles.bounces(cases), values, strict=True):
        bundles.expect_drop(
            scene,
            truth,
            value,
            t_end,
            h,
            "A ball that should come to rest, or lie on the floor from the start, moves otherwise.",
            "Each contact sends it up with e times its speed. Where it touches at g h or less it is put "
            "down: z = radius and v = 0 from then on.",
        )


@pytest.mark.task(bundles.DROP)
@pytest.mark.points(1)
def test_drop_elastic(submission, rng):
    """A ball with e = 1"""
    scene, t_end, h = draws.elastic(rng)
    value = submission.call(bundles.DROP, *scene.args(t_end, h))
    bundles.expect_drop(
        scene,
        bundles.bounces([(scene, t_end, h)])[0],
        value,
        t_end,
        h,
        "A ball that loses nothing in its bounces does not move as it should.",
        "It leaves the floor with the speed that it has at the instant of contact, and flies for the rest of "
        "the step.",
    )
