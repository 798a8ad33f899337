"""Checks of `order-of-a-method`."""

import pytest

from course.scoring import kit

CASES = [
    ((0.1, 0.02, 0.05, 0.01), 1.0),
    ((0.1, 0.04, 0.05, 0.01), 2.0),
    ((0.1, 0.01, 0.025, 3.90625e-05), 4.0),
    ((0.2, 0.3, 0.06, 0.05), 1.48820593189),
    ((0.1, 0.01, 0.05, 0.02), -1.0),
]


@pytest.mark.task("observed_order")
@pytest.mark.points(1)
def test_orders(submission):
    """Orders one, two and four, and one in between"""
    kit.expect_cases(
        submission,
        "observed_order",
        ("h", "error", "h_small", "error_small"),
        CASES,
        quantity="the order",
        message="The order is wrong.",
        help="By which factor did the step shrink, and by which the error?",
    )


#: Calls that tell wrong programs apart.
QUESTIONS = {"observed_order": [args for args, _ in CASES]}
