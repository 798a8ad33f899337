"""Checks of `fall-time`."""

import pytest

from course.scoring import kit


@pytest.mark.task("fall_time")
@pytest.mark.points(1)
def test_known_falls(submission):
    """Falls from 1, 20 and 300 m"""
    kit.expect_cases(
        submission,
        "fall_time",
        ("height", "g"),
        [
            ((1.0, 9.81), 0.451523640986),
            ((20.0,), 2.01927510938),  # on earth, unless another g is given
            ((300.0, 9.81), 7.82061887006),
        ],
        quantity="the time of the fall",
        units="s",
        message="The time of the fall is wrong.",
        help=(
            "Write down the height after a time t, and solve for the t at which it is zero. Steps in time"
            " are not exact enough."
        ),
    )


@pytest.mark.task("fall_time")
@pytest.mark.points(1)
def test_on_the_moon(submission):
    """The same fall on the Moon"""
    kit.expect_cases(
        submission,
        "fall_time",
        ("height", "g"),
        [((20.0, 1.62), 4.96903995)],
        quantity="the time of the fall",
        units="s",
        message="The time of a fall on the Moon is wrong.",
        help="Use the g that was given, in a formula without steps.",
    )


#: Calls that tell wrong programs apart.
QUESTIONS = {"fall_time": [(1.0, 9.81), (7.3, 9.81), (20.0, 1.62), (0.4, 3.7)]}
