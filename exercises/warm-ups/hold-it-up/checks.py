"""Checks of `hold-it-up`."""

import pytest

from course.scoring import kit

CASES = [
    ((2.0, 1.0, 0.0, 9.81), 9.81),
    ((3.0, 0.4, 0.7, 9.81), 4.50186111436),
    ((1.5, 0.8, -0.4, 1.62), 0.895271286171),
    ((1.0, 1.0, 2.0, 9.81), -2.04120023326),
    ((0.5, 2.0, -2.5, 1.62), -0.648926328593),
    ((2.0, 1.0, 0.0), 9.81),  # on earth, unless another g is given
]


@pytest.mark.task("holding_torque")
@pytest.mark.points(1)
def test_torques(submission):
    """Level, raised and lowered bars, and bars beyond upright"""
    kit.expect_cases(
        submission,
        "holding_torque",
        ("m", "l", "angle", "g"),
        CASES,
        quantity="the torque",
        units="N m",
        message="The torque is wrong.",
        help=("Where does gravity act on a uniform bar, and how far to the side of the motor is that?"),
    )


#: Calls that tell wrong programs apart.
QUESTIONS = {"holding_torque": [args for args, _ in CASES]}
