"""Checks of `equal-work`."""

import pytest

from course.scoring import kit


@pytest.mark.task("fair_step")
@pytest.mark.points(1)
def test_steps(submission):
    """Steps for engines with few iterations and with many"""
    kit.expect_cases(
        submission,
        "fair_step",
        ("h", "iterations", "other"),
        [
            ((0.01, 50, 10), 0.002),
            ((0.002, 8, 20), 0.005),
            ((0.005, 30, 30), 0.005),
            ((0.001, 20, 7), 0.00035),
        ],
        quantity="the step",
        units="s",
        message="The step of the other engine is wrong.",
        help="Count the iterations that the first engine makes in a simulated second.",
    )


#: Calls that tell wrong programs apart.
QUESTIONS = {"fair_step": [(0.01, 50, 10), (0.002, 8, 20), (0.005, 30, 7)]}
