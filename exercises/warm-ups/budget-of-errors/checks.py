"""Checks of `budget-of-errors`."""

import pytest

from course.scoring import kit


@pytest.mark.task("total_error")
@pytest.mark.points(1)
def test_budgets(submission):
    """Budgets of two, three and one"""
    cases = [
        (([3.0, 4.0],), 5.0),
        (([0.2, 0.5, 0.1],), 0.547722557505),
        (([1.0, 1.0, 1.0, 1.0],), 2.0),
    ]
    for args, expected in cases:
        kit.expect_close(
            submission.call("total_error", *args),
            expected,
            rel=1e-9,
            source="closed form, written down to twelve digits: only rounding is allowed",
            quantity="total error",
            units="1",
            input=dict(zip(("errors",), args, strict=True)),
            message="The total is wrong.",
            help="Two errors of 3 and 4 make 5.",
        )


#: Calls that tell wrong programs apart.
QUESTIONS = {
    "total_error": [
        ([3.0, 4.0],),
        ([0.2, 0.5, 0.1],),
        ([1.0, 1.0, 1.0, 1.0],),
    ],
}
