"""Public checks of ``collisions``: run as often as you like, and once more when you submit."""

from __future__ import annotations

import pytest

from course.scoring import kit

bundles = kit.companion("collisions", "bundles")
tracks, engine = bundles.tracks, bundles.engine


@pytest.mark.task(bundles.SPHERES)
@pytest.mark.points(4)
def test_sphere_contact(submission, draw):
    """Two spheres: do they touch, along which normal, and how deep?"""
    bundles.expect_public(
        submission,
        bundles.SPHERES,
        "sphere_contact",
        draw,
        "Touching, normal or depth of two spheres is wrong.",
        "With d the distance of the centres: normal (xb - xa)/d, depth ra + rb - d, touching where "
        "depth >= 0.",
    )


@pytest.mark.task(bundles.PLANE)
@pytest.mark.points(3)
def test_plane_contact(submission, draw):
    """A sphere and a plane: touching, normal and depth"""
    bundles.expect_public(
        submission,
        bundles.PLANE,
        "plane_contact",
        draw,
        "Touching, normal or depth of a sphere and a plane is wrong.",
        "The centre is (x - point) . normal above the plane. The depth is r less that, and the normal is "
        "the one you are given.",
    )


@pytest.mark.task(bundles.IMPULSE)
@pytest.mark.points(3)
def test_impulse_value(submission, draw):
    """The impulse of two bodies that approach each other"""
    bundles.expect_public(
        submission,
        bundles.IMPULSE,
        "impulse_value",
        draw,
        "The impulse of two bodies that meet on a line is wrong.",
        "J = (1 + e)(va - vb)/(1/ma + 1/mb). Check it: va - J/ma and vb + J/mb must differ by -e(va - vb).",
    )


@pytest.mark.task(bundles.IMPULSE)
@pytest.mark.points(2)
def test_impulse_separating(submission, draw):
    """Which bodies on a line get an impulse"""
    bundles.expect_public(
        submission,
        bundles.IMPULSE,
        "impulse_separating",
        draw,
        "The impulse of this pair is wrong. a is left of b: they approach, and get one, only where va > vb.",
        "Return 0.0 unless va > vb, and there J = (1 + e)(va - vb)/(1/ma + 1/mb).",
    )


@pytest.mark.task(bundles.IMPULSE)
@pytest.mark.points(0)
def test_impulse_walls(submission, draw):
    """A wall: one of the masses is infinite"""
    bundles.expect_walls(submission, bundles.IMPULSE, "impulse_walls", draw)


@pytest.mark.task(bundles.RESOLVE)
@pytest.mark.points(4)
def test_resolve_oblique(submission, draw):
    """An impact at an angle, along the normal and across it"""
    bundles.expect_public(
        submission,
        bundles.RESOLVE,
        "resolve_oblique",
        draw,
        "The velocities after an impact at an angle are wrong.",
        "With s = (va - vb) . n, the impulse is J n with J = (1 + e) s/(1/ma + 1/mb).",
    )


@pytest.mark.task(bundles.RESOLVE)
@pytest.mark.points(2)
def test_resolve_separating(submission, draw):
    """Which bodies are left alone"""
    bundles.expect_public(
        submission,
        bundles.RESOLVE,
        "resolve_separating",
        draw,
        "The velocities of this pair are wrong.",
        "Where (va - vb) . n > 0 the impulse is J n, with J = (1 + e) s/(1/ma + 1/mb). Elsewhere both "
        "velocities stay as they came.",
    )


@pytest.mark.task(bundles.RESOLVE)
@pytest.mark.points(0)
def test_resolve_walls(submission, draw):
    """A wall: one of the masses is infinite"""
    bundles.expect_walls(submission, bundles.RESOLVE, "resolve_walls", draw)


@pytest.mark.task(bundles.FRICTION)
@pytest.mark.points(4)
def test_friction_regimes(submission, draw):
    """Friction that slides, and friction that sticks"""
    bundles.expect_public(
        submission,
        bundles.FRICTION,
        "friction_regimes",
        draw,
        "The velocities after an impact with friction are wrong.",
        "Along the normal acts J, as in `resolve`. Across it acts min(mu J, |vt|/(1/ma + 1/mb)): on b "
        "against the slip vt of b seen from a, on a the other way.",
    )


@pytest.mark.task(bundles.FRICTION)
@pytest.mark.points(2)
def test_friction_absent(submission, draw):
    """Where friction is absent, and where it is not"""
    bundles.expect_public(
        submission,
        bundles.FRICTION,
        "friction_absent",
        draw,
        "The velocities of this pair are wrong.",
        "Without mu, slip or approach the result is that of `resolve`. Otherwise friction adds "
        "min(mu J, |vt|/(1/ma + 1/mb)) across the normal, on b against the slip.",
    )


@pytest.mark.task(bundles.FRICTION)
@pytest.mark.points(0)
def test_friction_walls(submission, draw):
    """A rough wall: one of the masses is infinite"""
    bundles.expect_walls(submission, bundles.FRICTION, "friction_walls", draw)


@pytest.mark.task(bundles.MOMENT)
@pytest.mark.points(4)
def test_moment_of_contact(submission, draw):
    """The moment of contact: head on, off centre, at a speed that jumps over the target"""
    bundles.expect_public(
        submission,
        bundles.MOMENT,
        "moment_of_contact",
        draw,
        "The time at which two moving spheres touch is wrong.",
        "The centres are ra + rb apart at contact: |dx + dv t| = ra + rb, a quadratic equation in t.",
    )


@pytest.mark.task(bundles.MOMENT)
@pytest.mark.points(2)
def test_moment_never(submission, draw):
    """Which spheres touch within the step, and which do not"""
    bundles.expect_public(
        submission,
        bundles.MOMENT,
        "moment_never",
        draw,
        "The answer for this pair is wrong.",
        "None if they do not approach, if there is no real root, or if t > dt. 0.0 if they overlap and "
        "approach. Otherwise the smaller root.",
    )


@pytest.mark.task(bundles.SPHERES)
@pytest.mark.points(0)
def test_sphere_arguments(submission, draw):
    """The arguments of detect_sphere_sphere after a call, and centres that coincide"""
    xa, ra, xb, rb = bundles.asked("sphere_kept", draw)[0]
    bundles.expect_kept(submission, bundles.SPHERES, (xa, ra, xb, rb))
    bundles.expect_one_centre(submission, [(xa, ra, xa.copy(), rb)])


@pytest.mark.task(bundles.PLANE)
@pytest.mark.points(0)
def test_plane_arguments(submission, draw):
    """The arguments of detect_sphere_plane after a call"""
    bundles.expect_kept(submission, bundles.PLANE, bundles.asked("plane_kept", draw)[0])


@pytest.mark.task(bundles.RESOLVE)
@pytest.mark.points(0)
def test_resolve_arguments(submission, draw):
    """The arguments of resolve after a call"""
    bundles.expect_kept(submission, bundles.RESOLVE, bundles.asked("resolve_kept", draw)[0])


@pytest.mark.task(bundles.FRICTION)
@pytest.mark.points(0)
def test_friction_arguments(submission, draw):
    """The arguments of resolve_with_friction after a call"""
    bundles.expect_kept(submission, bundles.FRICTION, bundles.asked("friction_kept", draw)[0])


@pytest.mark.task(bundles.MOMENT)
@pytest.mark.points(0)
def test_moment_arguments(submission, draw):
    """The arguments of time_of_impact after a call"""
    bundles.expect_kept(submission, bundles.MOMENT, bundles.asked("moment_kept", draw)[0])


@pytest.mark.task(bundles.HEAD_ON)
@pytest.mark.points(4)
def test_head_on_mended(submission, draw):
    """The mended program: two balls meet"""
    cases = bundles.asked("head_on_mended", draw)
    values = submission.call_each(bundles.HEAD_ON, [scene.args(t_end, h) for scene, t_end, h in cases])
    truths = bundles.meetings(cases, "head_on_mended")
    for (scene, t_end, h), truth, value in zip(cases, truths, values, strict=True):
        bundles.expect_head_on(
            scene,
            truth,
            value,
            t_end,
            h,
            "The two balls do not move as they should.",
            "Straight lines until the surfaces touch, the impact at that instant, straight lines after it.",
        )


@pytest.mark.task(bundles.HEAD_ON)
@pytest.mark.points(0)
def test_head_on_arguments(submission, draw):
    """The arguments of simulate_head_on after a call, and its samples"""
    scene, _, h = bundles.asked("head_on_kept", draw)[0]
    value = bundles.expect_kept(submission, bundles.HEAD_ON, scene.args(20 * h, h))
    # A program that is not mended yet leaves them alone as well, and has its samples wrong.
    bundles.samples(value, 20 * h, h, ("t", "x", "v"), scene.shown(20 * h, h), 2)


@pytest.mark.task(bundles.HEAD_ON)
@pytest.mark.points(2)
def test_head_on_pymunk(submission, draw):
    """Two unequal balls beside pymunk's"""
    cases = bundles.asked("head_on_pymunk", draw)
    (scene, t_end, h), truth = cases[0], bundles.meetings(cases, "head_on_pymunk")[0]
    given = scene.shown(t_end, h)
    value = submission.call(bundles.HEAD_ON, *scene.args(t_end, h))
    t, x, v = bundles.samples(value, t_end, h, ("t", "x", "v"), given, 2)
    theirs = engine.head_on(scene, t_end, h)
    for ball, error in enumerate(engine.head_on_error(scene, truth.after, h)):
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
            diagnose=lambda: tracks.of_head_on(scene, truth, t, x, v, h),
        )


@pytest.mark.task(bundles.DROP)
@pytest.mark.points(3)
def test_drop_bounces(submission, draw):
    """A bouncing ball: its flight, its contacts and its rest"""
    cases = bundles.asked("drop_bounces", draw)
    values = submission.call_each(bundles.DROP, [scene.args(t_end, h) for scene, t_end, h in cases])
    truths = bundles.bounces(cases, "drop_bounces")
    for (scene, t_end, h), truth, value in zip(cases, truths, values, strict=True):
        bundles.expect_drop(
            scene,
            truth,
            value,
            t_end,
            h,
            "The ball does not move as it should.",
            "Parabolas between contacts; each contact at its very instant, with e times the speed upwards; "
            "at rest once it touches with a speed of at most g h.",
        )


@pytest.mark.task(bundles.DROP)
@pytest.mark.points(1)
def test_drop_pymunk(submission, draw):
    """The dropped ball beside pymunk's"""
    cases = bundles.asked("drop_pymunk", draw)
    (scene, t_end, h), truth = cases[0], bundles.bounces(cases, "drop_pymunk")[0]
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
        diagnose=lambda: tracks.of_drop(scene, truth, t, z, v, h),
    )
