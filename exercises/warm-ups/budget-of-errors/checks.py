"""Checks of `budget-of-errors`."""

import pytest

from course.scoring import kit

CASES = [
    (([3.0, 4.0],), 5.0),
    (([0.2, 0.5, 0.1],), 0.547722557505),
    (([1.0, 1.0, 1.0, 1.0],), 2.0),
    (([0.1, 0.2, 0.2],), 0.3),
    (([0.25],), 0.25),
    (([3.0, 0.2],), 3.00665927567),
]


@pytest.mark.task("total_error")
@pytest.mark.points(1)
def test_budgets(submission):
    """Budgets of one error and of several"""
    kit.expect_cases(
        submission,
        "total_error",
        ("errors",),
        CASES,
        raised={"ValueError": "The list may have any number of errors: does your code expect a certain one?"},
        quantity="the total error",
        message="The total is wrong.",
        help="Two errors of 3 and 4 make 5.",
    )


#: Calls that tell wrong programs apart.
QUESTIONS = {"total_error": [args for args, _ in CASES]}
