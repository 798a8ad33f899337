"""Checks of `inside-the-cone`."""

import pytest

from course.scoring import kit

ASKED = {"expect": kit.expect_array, "abs": 1e-12, "quantity": "the friction impulse", "units": "N s"}
WITHIN_THE_LIMIT = [
    (([0.3, -0.4], 2.0, 0.5), [0.3, -0.4]),
    (([3.0, 0.0], 10.0, 0.5), [3.0, 0.0]),  # its square is beyond the limit
    (([0.0, 0.0], 1.0, 0.3), [0.0, 0.0]),
    (([0.0, 0.0], 0.0, 0.5), [0.0, 0.0]),
]
BEYOND_THE_LIMIT = [
    (([3.0, -5.0], 2.0, 0.5), [0.514495755428, -0.857492925713]),
    (([0.5, 1.2], 1.0, 0.65), [0.25, 0.6]),
    (([-1.0, 0.0], 3.0, 0.2), [-0.6, 0.0]),
    (([3.0, 3.5], 10.0, 0.4), [2.60316549382, 3.03702640946]),  # each component is within the limit
    (([0.3, 0.4], 0.0, 0.5), [0.0, 0.0]),
]


@pytest.mark.task("friction")
@pytest.mark.points(1)
def test_within(submission):
    """An impulse within the limit"""
    kit.expect_cases(
        submission,
        "friction",
        ("wanted", "normal", "mu"),
        WITHIN_THE_LIMIT,
        raised={"ZeroDivisionError": "Divide by the length of wanted only where it is beyond the limit."},
        **ASKED,
        message="A friction impulse within its limit is changed.",
        help="Compare its length with mu times the normal impulse.",
    )


@pytest.mark.task("friction")
@pytest.mark.points(1)
def test_beyond(submission):
    """An impulse beyond the limit"""
    kit.expect_cases(
        submission,
        "friction",
        ("wanted", "normal", "mu"),
        BEYOND_THE_LIMIT,
        **ASKED,
        message="A friction impulse beyond its limit is wrong.",
        help="Keep the direction, and give it the length of the limit.",
    )


#: Calls that tell wrong programs apart.
QUESTIONS = {"friction": [args for args, _ in WITHIN_THE_LIMIT + BEYOND_THE_LIMIT]}
