"""Checks of `faster-than-reality`."""

import pytest

from course.scoring import kit

CASES = [
    ((1000, 0.001, 0.5), 2.0),
    ((24000, 0.0025, 3.0), 20.0),
    ((300, 0.01, 12.0), 0.25),
    ((313, 0.013, 12.7), 0.320393700787),
]


@pytest.mark.task("real_time_factor")
@pytest.mark.points(1)
def test_factors(submission):
    """The real-time factors of three runs"""
    kit.expect_cases(
        submission,
        "real_time_factor",
        ("steps", "h", "wall"),
        CASES,
        quantity="the real-time factor",
        message="The real-time factor is wrong.",
        help="Work out first how much time passed inside the simulation.",
    )


#: Calls that tell wrong programs apart.
QUESTIONS = {"real_time_factor": [args for args, _ in CASES]}
