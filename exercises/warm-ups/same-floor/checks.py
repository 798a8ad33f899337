"""Checks of `same-floor`."""

import pytest

from course.scoring import kit

ANOTHER_STEP = [
    ((0.75, 0.0025, 0.01, 0.005), [0.6, 0.004]),
    ((0.4, 0.002, 0.004, 0.009), [0.6, 0.00133333333333]),
]
THE_SAME_STEP = [
    ((0.75, 0.0025, 0.01, 0.01), [0.75, 0.0025]),
    ((0.2, 0.01, 0.001, 0.001), [0.2, 0.01]),
]


def expect_floors(submission, cases, message, help):
    kit.expect_cases(
        submission,
        "same_floor",
        ("erp", "cfm", "h", "new_h"),
        cases,
        expect=kit.expect_array,
        quantity="the pair of ERP and CFM",
        message=message,
        help=help,
    )


@pytest.mark.task("same_floor")
@pytest.mark.points(1)
def test_another_step(submission):
    """The floor at another step"""
    expect_floors(
        submission,
        ANOTHER_STEP,
        "At the new step this is another floor.",
        "Which spring and which damper do these two numbers give at the new step?",
    )


@pytest.mark.task("same_floor")
@pytest.mark.points(1)
def test_the_same_step(submission):
    """The numbers at the same step"""
    expect_floors(
        submission,
        THE_SAME_STEP,
        "The step stays as it is, and the numbers change.",
        "With the old step the same spring and damper give the old numbers.",
    )


#: Calls that tell wrong programs apart.
QUESTIONS = {"same_floor": [args for args, _ in ANOTHER_STEP + THE_SAME_STEP]}
