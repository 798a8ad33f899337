"""Checks of `equal-work`."""

import pytest

from course.scoring import kit

CASES = [
    ((0.01, 50, 10), 0.002),
    ((0.002, 8, 20), 0.005),
    ((0.005, 30, 30), 0.005),
    ((0.005, 30, 7), 0.00116666666667),
    ((0.001, 30, 7), 0.000233333333333),
]


@pytest.mark.task("fair_step")
@pytest.mark.points(1)
def test_steps(submission):
    """Steps for engines with few iterations and with many"""
    kit.expect_cases(
        submission,
        "fair_step",
        ("h", "iterations", "other"),
        CASES,
        raised={"ZeroDivisionError": "8 // 20 is 0, and int cuts off, too: divide with one slash, /."},
        quantity="the step",
        units="s",
        message="The step of the other engine is wrong.",
        help="Count the iterations that the first engine makes in a simulated second.",
    )


#: Calls that tell wrong programs apart.
QUESTIONS = {"fair_step": [args for args, _ in CASES]}
