"""Public checks of ``collisions``: run as often as you like, and once more when you submit."""

from __future__ import annotations

import pytest

from course.grading import kit

bundles = kit.companion("collisions", "bundles")
probes, paths, engine = bundles.probes, bundles.paths, bundles.engine
call = bundles.call


@pytest.mark.task(bundles.SPHERES)
@pytest.mark.points(4)
def test_sphere_contact(submission):
    """Two spheres: do they touch, along which normal, how deep?"""
    calls = [
        call(bundles.SPHERES, [0, 0, 0], 0.5, [0.6, 0, 0.8], 0.7),
        call(bundles.SPHERES, [1, 2, -1], 1.0, [4, -2, -1], 1.5),
        call(bundles.SPHERES, [2, 1], 0.3, [2, -0.5], 1.4),
    ]
    bundles.expect_formula(
        submission,
        bundles.SPHERES,
        calls,
        "Touching, normal or depth of two spheres is wrong.",
        "With d the distance of the centres: normal (xb - xa)/d, depth ra + rb - d, touching where "
        "depth >= 0.",
    )


@pytest.mark.task(bundles.PLANE)
@pytest.mark.points(3)
def test_plane_contact(submission):
    """A sphere and a plane: a floor, a slope and a wall"""
    calls = [
        call(bundles.PLANE, [3, 1, 0.3], 0.5, [0, 0, 0], [0, 0, 1]),
        call(bundles.PLANE, [3, 1, 4], 1.0, [1, 0, 2], [0.6, 0, 0.8]),
        call(bundles.PLANE, [1, 1, 1], 0.5, [1, 0, 2], [0.6, 0, 0.8]),
        call(bundles.PLANE, [1.8, 7], 0.4, [2, 0], [-1, 0]),
    ]
    bundles.expect_formula(
        submission,
        bundles.PLANE,
        calls,
        "Touching, normal or depth of a sphere and a plane is wrong.",
        "The centre is (x - point) . normal above the plane, below it if negative; depth is r less that.",
    )


@pytest.mark.task(bundles.IMPULSE)
@pytest.mark.points(3)
def test_impulse_value(submission):
    """The impulse parts two bodies at e times the speed of approach"""
    calls = [(1.0, 1.0, 2.0, -2.0, 1.0), (1.0, 3.0, 2.0, -2.0, 0.5), (2.0, 1.0, 5.0, 1.0, 0.0)]
    calls += [(1.0, 4.0, -1.0, -3.0, 0.8)]
    bundles.expect_formula(
        submission,
        bundles.IMPULSE,
        calls,
        "The impulse of two bodies that meet on a line is wrong.",
        "J = (1 + e)(va - vb)/(1/ma + 1/mb). Check it: va - J/ma and vb + J/mb must differ by -e(va - vb).",
    )


@pytest.mark.task(bundles.IMPULSE)
@pytest.mark.points(2)
def test_impulse_separating(submission):
    """Bodies that move apart on a line get no impulse, and only those"""
    calls = [(1.0, 1.0, -2.0, 2.0, 1.0), (2.0, 3.0, 1.0, 4.0, 0.5), (1.0, 2.0, -3.0, -1.0, 0.3)]
    calls += [(2.0, 3.0, 4.0, 1.5, 0.5)]
    bundles.expect_formula(
        submission,
        bundles.IMPULSE,
        calls,
        "Which pairs get an impulse is wrong: a is left of b, so they approach where va > vb.",
        "Return 0.0 unless va > vb.",
    )


@pytest.mark.task(bundles.RESOLVE)
@pytest.mark.points(4)
def test_resolve_oblique(submission):
    """A blow at an angle changes what is along the normal and nothing across it"""
    calls = [
        call(bundles.RESOLVE, 1.0, 1.0, [2, 1, 0], [-2, 0, 3], [1, 0, 0], 1.0),
        call(bundles.RESOLVE, 1.0, 3.0, [4, 1, 2], [-1, 2, 0], [0.6, 0, 0.8], 0.5),
        call(bundles.RESOLVE, 5.0, 0.5, [0, -3], [1, 2], [0.8, -0.6], 0.3),
    ]
    bundles.expect_formula(
        submission,
        bundles.RESOLVE,
        calls,
        "The velocities after a blow at an angle are wrong.",
        "With s = (va - vb) . n, the impulse is J n with J = (1 + e) s/(1/ma + 1/mb).",
    )


@pytest.mark.task(bundles.RESOLVE)
@pytest.mark.points(2)
def test_resolve_separating(submission):
    """Bodies that move apart are left alone, and only those"""
    calls = [
        call(bundles.RESOLVE, 1.0, 2.0, [-1, 5, 0], [2, 0, 0], [1, 0, 0], 0.8),
        call(bundles.RESOLVE, 2.0, 1.0, [1, 2, 3], [1, 4, 3], [0, 1, 0], 0.5),
        call(bundles.RESOLVE, 2.0, 1.0, [1, 2, 3], [1, 4, 3], [0, -1, 0], 0.5),
    ]
    bundles.expect_formula(
        submission,
        bundles.RESOLVE,
        calls,
        "Which pairs get a blow is wrong: they approach where (va - vb) . n > 0.",
        "Return the velocities as they came unless (va - vb) . n > 0.",
    )


@pytest.mark.task(bundles.FRICTION)
@pytest.mark.points(4)
def test_friction_regimes(submission):
    """Friction slides on a smooth surface and sticks on a rough one"""
    args = 1.0, 3.0, [4, 2, -1], [-2, 0, 2], [1, 0, 0], 0.5
    calls = [call(bundles.FRICTION, *args, mu) for mu in (0.1, 0.3, 0.9, 4.0)]
    calls += [call(bundles.FRICTION, 2.0, 1.0, [1, -3], [0, 1], [0, -1], 0.2, 0.15)]
    bundles.expect_formula(
        submission,
        bundles.FRICTION,
        calls,
        "The velocities after a blow with friction are wrong.",
        "Across the normal acts min(mu J, |vt|/(1/ma + 1/mb)), against the slip vt of b seen from a.",
    )


@pytest.mark.task(bundles.FRICTION)
@pytest.mark.points(2)
def test_friction_absent(submission):
    """Without a coefficient, without slip or without a blow there is no friction"""
    calls = [
        call(bundles.FRICTION, 1.0, 2.0, [3, 1, 0], [0, 0, 2], [1, 0, 0], 0.5, 0.0),
        call(bundles.FRICTION, 1.0, 2.0, [3, 1, 0], [0, 1, 0], [1, 0, 0], 0.5, 0.4),
        call(bundles.FRICTION, 1.0, 2.0, [0, 1, 0], [3, 0, 2], [1, 0, 0], 0.5, 0.4),
        call(bundles.FRICTION, 1.0, 2.0, [3, 1, 0], [0, 0, 2], [1, 0, 0], 0.5, 0.4),
    ]
    bundles.expect_formula(
        submission,
        bundles.FRICTION,
        calls,
        "Where nothing rubs (no coefficient, no slip, no blow), or next to it, the velocities are wrong.",
        "With no slip there is no direction to oppose: divide by |vt| only if it is not zero.",
    )


@pytest.mark.task(bundles.MOMENT)
@pytest.mark.points(4)
def test_moment_of_contact(submission):
    """The moment of contact is found head on, off centre and at a speed that jumps over the target"""
    calls = [
        call(bundles.MOMENT, [-5, 0, 0], [2, 0, 0], 0.5, [5, 0, 0], [-2, 0, 0], 0.5, 5.0),
        call(bundles.MOMENT, [-1, 0, 0], [400, 0, 0], 0.01, [0, 0, 0], [0, 0, 0], 0.01, 0.01),
        call(bundles.MOMENT, [0, 0, 0], [3, 0, 0], 0.5, [4, 0.6, 0], [0, 0, 0], 0.5, 1.4),
        call(bundles.MOMENT, [0, 0], [0, 1], 0.3, [1.5, 2], [-1, 0], 0.4, 4.0),
    ]
    bundles.expect_formula(
        submission,
        bundles.MOMENT,
        calls,
        "The time at which two moving spheres touch is wrong.",
        "The centres are ra + rb apart at contact: |dx + dv t| = ra + rb, a quadratic equation in t.",
    )


@pytest.mark.task(bundles.MOMENT)
@pytest.mark.points(2)
def test_moment_never(submission):
    """None where they pass by, part, keep their distance or meet after the step, and only there"""
    still, there = [0, 0, 0], [4, 0, 0]
    calls = [
        call(bundles.MOMENT, still, [3, 1.5, 0], 0.5, there, [0, 0, 0], 0.5, 9.0),
        call(bundles.MOMENT, still, [-1, 0, 0], 0.5, there, [1, 0, 0], 0.5, 9.0),
        call(bundles.MOMENT, still, [2, 1, 0], 0.5, there, [2, 1, 0], 0.5, 9.0),
        call(bundles.MOMENT, still, [1, 0, 0], 0.5, there, [0, 0, 0], 0.5, 2.0),
        call(bundles.MOMENT, still, [1, 0, 0], 0.5, there, [0, 0, 0], 0.5, 4.0),
        call(bundles.MOMENT, still, [1, 0, 0], 0.5, there, [0, 0, 0], 0.5, 6.0),
    ]
    bundles.expect_formula(
        submission,
        bundles.MOMENT,
        calls,
        "Whether two moving spheres touch within the step is wrong.",
        "None if the centres do not come nearer, if the quadratic has no real root, or if t > dt.",
    )


@pytest.mark.task(bundles.HEAD_ON)
@pytest.mark.points(4)
def test_head_on_mended(submission):
    """The mended program: two balls of 0.5 m meet at 2.25 s and part as e says"""
    scenes = [paths.HeadOn((1.0, 1.0), (-5.0, 5.0), (2.0, -2.0), 0.5, e) for e in (1.0, 0.5, 0.0)]
    values = submission.call_each(bundles.HEAD_ON, [scene.args(5.0, 0.01) for scene in scenes])
    for scene, value in zip(scenes, values, strict=True):
        bundles.expect_head_on(
            scene,
            value,
            5.0,
            0.01,
            "The two balls do not move as they should.",
            "Straight lines until the surfaces touch, the blow at that very instant, straight lines after.",
        )


@pytest.mark.task(bundles.HEAD_ON)
@pytest.mark.points(2)
def test_head_on_pymunk(submission):
    """Two unequal balls move as in pymunk, to within pymunk's own error"""
    t_end, h = 4.8, 0.008
    scene = paths.HeadOn((1.0, 3.0), (-5.0, 5.0), (2.0, -2.0), 0.5, 0.6)
    given = scene.shown(t_end, h)
    value = submission.call(bundles.HEAD_ON, *scene.args(t_end, h))
    t, x, v = bundles.samples(value, t_end, h, ("t", "x", "v"), given, 2)
    theirs = engine.head_on(scene, t_end, h)
    for ball, error in enumerate(engine.head_on_error(scene, h)):
        kit.expect_array(
            x[:, ball],
            theirs[:, ball],
            abs=error,
            source="pymunk notices a contact up to one step late: h times the change of velocity",
            quantity=f"x of ball {ball + 1}",
            units="m",
            t=t,
            input=given,
            message="Your balls and pymunk's are further apart than pymunk's own error explains.",
            help="Compare with straight lines that bend at the time of contact.",
            diagnose=lambda: probes.of_head_on(scene, t, x, v, h),
        )


@pytest.mark.task(bundles.DROP)
@pytest.mark.points(3)
def test_drop_bounces(submission):
    """A dropped ball bounces to e squared of its height, time after time, and then lies still"""
    scenes = [paths.Drop(1.0, 0.0, 0.1, 0.7), paths.Drop(0.5, 3.0, 0.2, 0.5)]
    values = submission.call_each(bundles.DROP, [scene.args(4.0, 0.01) for scene in scenes])
    for scene, value in zip(scenes, values, strict=True):
        bundles.expect_drop(
            scene,
            value,
            4.0,
            0.01,
            "The ball does not move as it should.",
            "Parabolas between contacts; each contact at its very instant, with e times the speed upwards; "
            "at rest once it touches with a speed of at most g h.",
        )


@pytest.mark.task(bundles.DROP)
@pytest.mark.points(1)
def test_drop_pymunk(submission):
    """The ball falls and bounces as in pymunk, to within pymunk's own error"""
    scene, h = paths.Drop(1.0, 0.0, 0.1, 0.7), 0.002
    t_end = 0.9  # before the second contact, from which on pymunk's errors add up
    given = scene.shown(t_end, h)
    value = submission.call(bundles.DROP, *scene.args(t_end, h))
    t, z, v = bundles.samples(value, t_end, h, ("t", "z", "v"), given)
    kit.expect_array(
        z,
        engine.drop(scene, t_end, h)[:, 0],
        abs=engine.drop_error(scene, h),
        source="pymunk bounces up to one and a half steps late: that times the change of velocity",
        quantity="z",
        units="m",
        t=t,
        input=given,
        message="Your ball and pymunk's are further apart than pymunk's own error explains.",
        help="Compare with parabolas that meet at the times of contact.",
        diagnose=lambda: probes.of_drop(scene, t, z, v, h),
    )
