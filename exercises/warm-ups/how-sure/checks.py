"""Checks of `how-sure`."""

import pytest

from course.scoring import kit

CASES = [
    (([1.0, 3.0],), 1.0),
    (([2.0, 4.0, 4.0, 6.0],), 0.816496580928),
    (([9.8, 9.9, 9.7, 9.8, 10.1, 9.6, 9.8, 9.9, 9.7],), 0.0484322104838),
]


@pytest.mark.task("standard_error")
@pytest.mark.points(1)
def test_samples(submission):
    """Samples of two, four and nine values"""
    kit.expect_cases(
        submission,
        "standard_error",
        ("values",),
        CASES,
        quantity="the standard error",
        message="The standard error is wrong.",
        help=(
            "Print two numbers: the standard deviation of the values, with n - 1, and the root of n."
            " The result is the first over the second."
        ),
    )


#: Calls that tell wrong programs apart.
QUESTIONS = {"standard_error": [args for args, _ in CASES]}
