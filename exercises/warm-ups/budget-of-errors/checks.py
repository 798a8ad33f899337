"""Checks of `budget-of-errors`."""

import pytest

from course.scoring import kit


@pytest.mark.task("total_error")
@pytest.mark.points(1)
def test_budgets(submission):
    """Budgets of one error and of several"""
    kit.expect_accepts(
        lambda: submission.call("total_error", [3.0, 4.0]),
        "ValueError",
        input={"errors": [3.0, 4.0]},
        message="Your code stops with a ValueError.",
        help="The list may have any number of errors: does your code expect a certain one?",
    )
    kit.expect_cases(
        submission,
        "total_error",
        ("errors",),
        [
            (([3.0, 4.0],), 5.0),
            (([0.2, 0.5, 0.1],), 0.547722557505),
            (([1.0, 1.0, 1.0, 1.0],), 2.0),
            (([0.1, 0.2, 0.2],), 0.3),
            (([0.25],), 0.25),
            (([3.0, 0.2],), 3.00665927567),
        ],
        quantity="the total error",
        message="The total is wrong.",
        help="Two errors of 3 and 4 make 5.",
    )


#: Calls that tell wrong programs apart.
QUESTIONS = {
    "total_error": [
        ([3.0, 4.0],),
        ([0.2, 0.5, 0.1],),
        ([1.0, 1.0, 1.0, 1.0],),
        ([0.1, 0.2, 0.2],),
        ([3.0, 0.2],),
    ]
}
