"""Checks of `overlap-of-balls`."""

import pytest

from course.scoring import kit

CASES = [
    (([0.0, 0.0], [0.3, 0.4], 0.4, 0.3), 0.2),
    (([1.0, -2.0], [4.0, 2.0], 1.5, 2.0), -1.5),
    (([0.2, 0.1], [0.2, 0.3], 0.5, 0.1), 0.4),
    (([0.5, 1.0], [-0.7, 0.3], 0.9, 1.1), 0.610755601055),
    (([-0.3, -0.4], [-0.3, -0.4], 0.2, 0.3), 0.5),
]


@pytest.mark.task("overlap")
@pytest.mark.points(1)
def test_depths(submission):
    """Overlapping balls and balls apart"""
    kit.expect_cases(
        submission,
        "overlap",
        ("p", "q", "r1", "r2"),
        CASES,
        quantity="the depth",
        units="m",
        message="The depth is wrong.",
        help="How far is p from q, in the plane? Compare that with the two radii.",
    )


#: Calls that tell wrong programs apart.
QUESTIONS = {"overlap": [args for args, _ in CASES]}
