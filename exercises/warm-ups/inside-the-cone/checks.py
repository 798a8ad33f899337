"""Checks of `inside-the-cone`."""

import pytest

from course.scoring import kit


@pytest.mark.task("friction")
@pytest.mark.points(1)
def test_within(submission):
    """An impulse within the limit"""
    kit.expect_cases(
        submission,
        "friction",
        ("wanted", "normal", "mu"),
        [(([0.3, -0.4], 2.0, 0.5), [0.3, -0.4]), (([0.0, 0.0], 1.0, 0.3), [0.0, 0.0])],
        expect=kit.expect_array,
        abs=1e-12,
        source="closed form; absolute 1e-12 N s where it is zero",
        quantity="the friction impulse",
        units="N s",
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
        [
            (([3.0, -4.0], 2.0, 0.5), [0.6, -0.8]),
            (([0.5, 1.2], 1.0, 0.65), [0.25, 0.6]),
            (([-1.0, 0.0], 3.0, 0.2), [-0.6, 0.0]),
            (([0.3, 0.4], 0.0, 0.5), [0.0, 0.0]),
        ],
        expect=kit.expect_array,
        abs=1e-12,
        source="closed form; absolute 1e-12 N s where it is zero",
        quantity="the friction impulse",
        units="N s",
        message="A friction impulse beyond its limit is wrong.",
        help="Keep the direction, and give it the length of the limit.",
    )


#: Calls that tell wrong programs apart.
QUESTIONS = {
    "friction": [
        ([0.3, -0.4], 2.0, 0.5),
        ([3.0, -4.0], 2.0, 0.5),
        ([0.5, 1.2], 1.0, 0.65),
        ([-1.0, 0.0], 3.0, 0.2),
        ([0.7, 0.7], 2.0, 0.45),
        ([0.0, 0.0], 1.0, 0.3),
    ]
}
