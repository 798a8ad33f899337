"""Checks of `friction-from-a-slide`."""

import pytest

from course.scoring import kit

CASES = [
    ((2.0, 0.5, 9.81), 0.407747196738),
    ((1.5, 1.2), 0.0955657492355),  # on earth, unless another g is given
    ((1.0, 0.8, 1.62), 0.385802469136),
]


@pytest.mark.task("friction_coefficient")
@pytest.mark.points(1)
def test_slides(submission):
    """Three slides, one of them on the Moon"""
    kit.expect_cases(
        submission,
        "friction_coefficient",
        ("v", "distance", "g"),
        CASES,
        quantity="the coefficient of friction",
        message="The coefficient is wrong.",
        help="Energy at the start equals force times distance.",
    )


#: Calls that tell wrong programs apart.
QUESTIONS = {"friction_coefficient": [args for args, _ in CASES]}
