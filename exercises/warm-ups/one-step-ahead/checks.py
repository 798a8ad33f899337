"""Checks of `one-step-ahead`."""

import pytest

from course.scoring import kit

CASES = [
    ((0.0, 2.0, -9.81, 0.1), [0.2, 1.019]),
    ((-1.5, -0.5, 3.0, 0.1234567), [-1.56172835, -0.1296299]),
    ((10.0, 1.3, 0.7, 0.9), [11.17, 1.93]),
]


@pytest.mark.task("step_ahead")
@pytest.mark.points(1)
def test_steps(submission):
    """Steps forwards from three states"""
    kit.expect_cases(
        submission,
        "step_ahead",
        ("x", "v", "a", "h"),
        CASES,
        expect=kit.expect_array,
        quantity="the pair of position and velocity",
        message="The state after a step is wrong.",
        help="Write down x, v and a before the step, and use only these.",
    )


#: Calls that tell wrong programs apart.
QUESTIONS = {"step_ahead": [args for args, _ in CASES]}
