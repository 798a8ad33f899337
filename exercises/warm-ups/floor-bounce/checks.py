"""Checks of `floor-bounce`."""

import pytest

from course.scoring import kit

ASKED = {"abs": 1e-12, "quantity": "the velocity afterwards", "units": "m/s"}
ON_THE_WAY_DOWN = [
    ((-3.0, 0.8), 2.4),
    ((-0.25, 0.5), 0.125),
    ((-1.234567, 0.7), 0.8641969),
    ((-1.3, 0.0), 0.0),
    ((-0.005, 0.5), 0.0025),
]
ON_THE_WAY_UP = [((2.0, 0.8), 2.0), ((0.5, 0.3), 0.5), ((0.0, 0.4), 0.0), ((1.0, 0.0), 1.0)]


@pytest.mark.task("after_floor")
@pytest.mark.points(1)
def test_on_the_way_down(submission):
    """A falling ball"""
    kit.expect_cases(
        submission,
        "after_floor",
        ("v", "e"),
        ON_THE_WAY_DOWN,
        **ASKED,
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
        ON_THE_WAY_UP,
        **ASKED,
        message="A ball that does not move into the floor has another velocity now.",
        help="Ask first whether the ball is moving into the floor.",
    )


#: Calls that tell wrong programs apart.
QUESTIONS = {"after_floor": [args for args, _ in ON_THE_WAY_DOWN + ON_THE_WAY_UP]}
