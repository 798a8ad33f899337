"""Checks of `let-it-go`."""

import pytest

from course.scoring import kit

CASES = [
    ((0.0, 2.0, 1.0, 0.0), -14.715),  # on earth, unless another g is given
    ((12.0, 2.0, 1.5, 0.3, 9.81), -1.37185095832),
    ((-1.0, 0.5, 0.6, -1.0, 1.62), -18.8548910054),
    ((1.5, 2.0, 0.8, 2.5, 9.81), 18.2516603785),
]


@pytest.mark.task("angular_acceleration")
@pytest.mark.points(1)
def test_accelerations(submission):
    """With and without the motor, at several angles"""
    kit.expect_cases(
        submission,
        "angular_acceleration",
        ("torque", "m", "l", "angle", "g"),
        CASES,
        quantity="the angular acceleration",
        units="rad/s^2",
        message="The angular acceleration is wrong.",
        help="Add the torques first, then divide by the moment of inertia about the end.",
    )


#: Calls that tell wrong programs apart.
QUESTIONS = {"angular_acceleration": [args for args, _ in CASES]}
