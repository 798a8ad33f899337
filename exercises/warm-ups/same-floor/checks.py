"""Checks of `same-floor`."""

import pytest

from course.scoring import kit

NAMES = ("erp", "cfm", "h", "new_h")


def _expect(submission, args, expected, message, help):
    kit.expect_array(
        submission.call("same_floor", *args),
        list(expected),
        rel=1e-9,
        source="closed form, written down to twelve digits: only rounding is allowed",
        quantity="the pair of ERP and CFM",
        input=dict(zip(NAMES, args, strict=True)),
        message=message,
        help=help,
    )


@pytest.mark.task("same_floor")
@pytest.mark.points(1)
def test_another_step(submission):
    """The floor at another step"""
    for args, expected in (
        ((0.75, 0.0025, 0.01, 0.005), (0.6, 0.004)),
        ((0.4, 0.002, 0.004, 0.01), (0.625, 0.00125)),
    ):
        _expect(
            submission,
            args,
            expected,
            "At the new step this is another floor.",
            "Which spring and which damper do these two numbers give at the new step?",
        )


@pytest.mark.task("same_floor")
@pytest.mark.points(1)
def test_the_same_step(submission):
    """The numbers at the same step"""
    for args in ((0.75, 0.0025, 0.01, 0.01), (0.2, 0.01, 0.001, 0.001)):
        _expect(
            submission,
            args,
            args[:2],
            "The step stays as it is, and the numbers change.",
            "With the old step the same spring and damper give the old numbers.",
        )


#: Calls that tell wrong programs apart.
QUESTIONS = {
    "same_floor": [(0.75, 0.0025, 0.01, 0.005), (0.4, 0.002, 0.004, 0.01), (0.2, 0.01, 0.001, 0.001)]
}
