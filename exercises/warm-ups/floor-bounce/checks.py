"""Checks of `floor-bounce`."""

import pytest

from course.scoring import kit


@pytest.mark.task("after_floor")
@pytest.mark.points(1)
def test_on_the_way_down(submission):
    """A falling ball"""
    kit.expect_cases(
        submission,
        "after_floor",
        ("v", "e"),
        [
            ((-3.0, 0.8), 2.4),
            ((-0.25, 0.5), 0.125),
            ((-2.0, 0.3), 0.6),
            ((-1.3, 0.0), 0.0),
            ((-0.005, 0.5), 0.0025),
        ],
        abs=1e-12,
        source="closed form; absolute 1e-12 m/s where it is zero",
        quantity="the velocity afterwards",
        units="m/s",
        message="The velocity after a bounce is wrong.",
        help=("Restitution is the speed after over the speed before, and the direction turns round."),
    )


@pytest.mark.task("after_floor")
@pytest.mark.points(1)
def test_on_the_way_up(submission):
    """A rising or resting ball"""
    kit.expect_cases(
        submission,
        "after_floor",
        ("v", "e"),
        [((2.0, 0.8), 2.0), ((0.5, 0.3), 0.5), ((0.0, 0.4), 0.0), ((1.0, 0.0), 1.0)],
        abs=1e-12,
        source="closed form; absolute 1e-12 m/s where it is zero",
        quantity="the velocity afterwards",
        units="m/s",
        message="A ball that does not move into the floor has another velocity now.",
        help="Ask first whether the ball is moving into the floor.",
    )


#: Calls that tell wrong programs apart.
QUESTIONS = {
    "after_floor": [
        (-3.0, 0.8),
        (2.0, 0.8),
        (-0.25, 0.5),
        (0.0, 0.4),
        (0.5, 0.3),
        (-1.0, 1.0),
        (-1.3, 0.0),
        (-0.005, 0.5),
    ]
}
