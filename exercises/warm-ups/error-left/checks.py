"""Checks of `error-left`."""

import pytest

from course.scoring import kit

CASES = [
    ((10.4, 10.1, 2.0, 2.0), 0.1),
    ((10.4, 10.2, 2.0, 1.0), 0.2),
    ((-3.0, -2.68, 3.0, 2.0), -0.04),
    ((1.0, 1.255, 4.0, 4.0), -0.001),
    ((7.0, 6.0, 10.0, 1.5), 0.0326554320337),
]


@pytest.mark.task("error_left")
@pytest.mark.points(1)
def test_errors(submission):
    """Orders one, two, four and one and a half, several factors, results too large and too small"""
    kit.expect_cases(
        submission,
        "error_left",
        ("coarse", "fine", "factor", "order"),
        CASES,
        quantity="the error left",
        message="That is not the error that is left.",
        help="Say the exact result is 0 and fine is 1. What is coarse then, with this factor and order?",
    )


#: Calls that tell wrong programs apart.
QUESTIONS = {"error_left": [args for args, _ in CASES]}
