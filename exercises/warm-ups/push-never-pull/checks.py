"""Checks of `push-never-pull`."""

import pytest

from course.scoring import kit


@pytest.mark.task("applied")
@pytest.mark.points(1)
def test_corrections(submission):
    """Corrections up, down, and further down than there is"""
    kit.expect_cases(
        submission,
        "applied",
        ("total", "wanted"),
        [
            ((3.0, 2.0), 2.0),
            ((3.0, -1.0), -1.0),
            ((3.0, -5.0), -3.0),
            ((0.5, -0.25), -0.25),
            ((0.0, -2.0), 0.0),
            ((0.5, 2.0), 2.0),
            ((0.0, 2.0), 2.0),
        ],
        abs=1e-12,
        source="closed form; absolute 1e-12 N s where it is zero",
        quantity="the correction applied",
        units="N s",
        message="The correction is wrong.",
        help="Look at the sum after the correction, not at the correction.",
    )


#: Calls that tell wrong programs apart.
QUESTIONS = {
    "applied": [
        (3.0, 2.0),
        (3.0, -1.0),
        (3.0, -5.0),
        (0.0, -2.0),
        (0.5, -0.25),
        (0.7, 0.4),
        (0.5, 2.0),
        (0.0, 2.0),
    ]
}
