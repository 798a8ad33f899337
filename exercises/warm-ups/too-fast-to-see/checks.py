"""Checks of `too-fast-to-see`."""

import pytest

from course.scoring import kit

CASES = [
    ((0.1, 0.05, 0.01), 20.0),
    ((0.02, 0.003, 0.004), 6.5),
    ((0.5, 0.0, 0.02), 25.0),
    ((0.1, 0.05, 0.003), 66.6666666667),
]


@pytest.mark.task("fastest")
@pytest.mark.points(1)
def test_speeds(submission):
    """Thick and thin walls, large and small balls"""
    kit.expect_cases(
        submission,
        "fastest",
        ("thickness", "radius", "h"),
        CASES,
        quantity="the largest speed",
        units="m/s",
        message="The largest speed is wrong.",
        help="How far does the ball travel while it overlaps the wall?",
    )


#: Calls that tell wrong programs apart.
QUESTIONS = {"fastest": [args for args, _ in CASES]}
