"""Checks of `singular-pose`."""

import pytest

from course.scoring import kit

NAMES = ("angle", "length", "vx", "vy")
SPEEDS = [
    ((0.0, 2.0, 0.0, 1.0), [0.0, 0.5]),
    ((0.5, 2.0, 0.3, 0.0), [0.3, 0.0]),
    ((0.5, 2.0, 0.3, 0.4), [0.518520995938, 0.227898785465]),
    ((2.5, 0.8, -0.2, 0.6), [-0.648213378343, -0.936161738602]),
    ((-1.2, 1.5, 1.0, -0.5), [2.28607581106, -0.919901200444]),
]
SINGULAR_POSES = [
    ((1.5707963267948966, 2.0, 0.3, 0.4), True),
    ((-1.5707963267948966, 1.0, 0.0, 1.0), True),
    ((1.5707963267948966, 2.0, 0.3, 0.0), True),
    ((4.71238898038469, 1.0, 0.0, 1.0), True),
    ((-4.71238898038469, 1.5, 0.3, 0.4), True),
    ((1.5707963262948966, 3.0, 0.3, 0.4), True),
    ((1.57, 2.0, 0.3, 0.4), False),
    ((0.0, 2.0, 0.3, 0.4), False),
    ((0.4, 2.0, 0.0, 0.0), False),
]


@pytest.mark.task("joint_speeds")
@pytest.mark.points(1)
def test_speeds(submission):
    """Four poses, with motions along the rail, across it and both"""
    for args, expected in SPEEDS:
        found = submission.call("joint_speeds", *args)
        kit.expect_true(
            found is not None,
            "You give None in a pose in which the tip can move in every direction.",
            expected="a pair",
            input=dict(zip(NAMES, args, strict=True)),
            help="Only an upright rod cannot move its tip up or down. In other poses return both speeds.",
        )
        kit.expect_array(
            found,
            expected,
            rel=1e-9,
            abs=1e-9,
            source="closed form; absolute 1e-9 where it is zero",
            quantity="the pair of speeds",
            units="m/s and rad/s",
            input=dict(zip(NAMES, args, strict=True)),
            message="The speeds of the joints are wrong.",
            help="Put them back: differentiate x and y of the tip. Do your speeds give vx and vy?",
        )


@pytest.mark.task("joint_speeds")
@pytest.mark.points(1)
def test_singular_poses(submission):
    """Poses in which the tip can only move along the rail, and others"""
    for args, singular in SINGULAR_POSES:
        found = submission.call("joint_speeds", *args)
        kit.expect_true(
            (found is None) == singular,
            "You do not give None in a pose in which the tip can only move along the rail."
            if singular
            else "You give None in a pose in which the tip can move in every direction.",
            expected=None if singular else "a pair",
            actual=found,
            input=dict(zip(NAMES, args, strict=True)),
            help="math.cos(math.pi / 2) is not exactly zero: compare |cos(angle)| with 1e-9.",
        )


#: Calls that tell wrong programs apart.
QUESTIONS = {"joint_speeds": [args for args, _ in SPEEDS + SINGULAR_POSES]}
