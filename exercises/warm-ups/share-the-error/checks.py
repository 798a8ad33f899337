"""Checks of `share-the-error`."""

import pytest

from course.scoring import kit

CASES = [
    ((1.0, 1.4, 0.25), 1.1),
    ((2.0, 1.0, 0.9), 1.1),
    ((-0.5, 0.7, 1.0), 0.7),
    ((3.0, 8.0, 0.1), 3.5),
    ((2.5, -1.5, 0.0), 2.5),
    ((-0.5, -1.3, 0.123457), -0.5987656),
]


@pytest.mark.task("corrected")
@pytest.mark.points(1)
def test_corrections(submission):
    """Small, large and whole corrections, and none"""
    kit.expect_cases(
        submission,
        "corrected",
        ("predicted", "measured", "share"),
        CASES,
        quantity="the position",
        units="m",
        message="The corrected position is wrong.",
        help="With the share 0 the prediction must come out, with 1 the measurement.",
    )


#: Calls that tell wrong programs apart.
QUESTIONS = {"corrected": [args for args, _ in CASES]}
