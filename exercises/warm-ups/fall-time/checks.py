"""Checks of `fall-time`."""

import pytest

from course.scoring import kit

KNOWN_FALLS = [
    ((1.0, 9.81), 0.451523640986),
    ((20.0,), 2.01927510938),  # on earth, unless another g is given
    ((300.0, 9.81), 7.82061887006),
]
ON_THE_MOON = [((20.0, 1.62), 4.96903995)]


@pytest.mark.task("fall_time")
@pytest.mark.points(1)
def test_known_falls(submission):
    """Falls from 1, 20 and 300 m"""
    kit.expect_cases(
        submission,
        "fall_time",
        ("height", "g"),
        KNOWN_FALLS,
        quantity="the time of the fall",
        units="s",
        message="The time of the fall is wrong.",
        help=(
            "Write down the height after a time t, and solve for the t at which it is zero. Take no steps"
            " in time, and do not round."
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
        ON_THE_MOON,
        quantity="the time of the fall",
        units="s",
        message="The time of a fall on the Moon is wrong.",
        help="Use the g that was given, in the same formula: no steps in time, and no rounding.",
    )


#: Calls that tell wrong programs apart.
QUESTIONS = {"fall_time": [args for args, _ in KNOWN_FALLS + ON_THE_MOON]}
