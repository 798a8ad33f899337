"""Checks of `too-far-apart`."""

import pytest

from course.scoring import kit

CASES = [
    ((1.2, 0.03, 1.25, 0.04), 1.0),
    ((5.0, 0.2, 4.0, 0.1), 4.472135955),
    ((0.0, 1.0, 2.6, 2.4), 1.0),
    ((-0.4, 0.3, 0.5, 0.4), 1.8),
    ((-2.5, 0.1, -2.0, 0.2), 2.2360679775),
]


@pytest.mark.task("distance_in_doubts")
@pytest.mark.points(1)
def test_distances(submission):
    """Larger and smaller results, sure and unsure ones"""
    kit.expect_cases(
        submission,
        "distance_in_doubts",
        ("simulated", "doubt_s", "measured", "doubt_m"),
        CASES,
        quantity="the distance in doubts",
        message="The difference in units of its uncertainty is wrong.",
        help="What is the uncertainty of a difference of two uncertain numbers?",
    )


#: Calls that tell wrong programs apart.
QUESTIONS = {"distance_in_doubts": [args for args, _ in CASES]}
