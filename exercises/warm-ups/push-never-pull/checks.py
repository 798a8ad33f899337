"""Checks of `push-never-pull`."""

import pytest

from course.scoring import kit

CASES = [
    ((3.0, 2.0), 2.0),
    ((3.0, -1.0), -1.0),
    ((3.0, -5.0), -3.0),
    ((0.7654321, -0.1234567), -0.1234567),
    ((0.0, -2.0), 0.0),
    ((0.5, 2.0), 2.0),
    ((0.0, 2.0), 2.0),
]


@pytest.mark.task("applied")
@pytest.mark.points(1)
def test_corrections(submission):
    """Corrections up, down, and further down than there is"""
    kit.expect_cases(
        submission,
        "applied",
        ("total", "wanted"),
        CASES,
        abs=1e-12,
        quantity="the correction applied",
        units="N s",
        message="The correction is wrong.",
        help="Look at the sum after the correction, not at the correction.",
    )


#: Calls that tell wrong programs apart.
QUESTIONS = {"applied": [args for args, _ in CASES]}
